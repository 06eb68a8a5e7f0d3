"""Contacts: where surfaces meet, how hard they press, how they rub."""
