"""The control loops of a scene's magnetic bearings: sensitivity, margins and poles, before a drop."""
