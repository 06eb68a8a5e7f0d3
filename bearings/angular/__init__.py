"""Ball bearings with a contact angle: rows between circles of groove centres, loads in space, statics."""
