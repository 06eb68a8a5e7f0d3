"""Contacts: normal and friction laws, two bodies that touch, where they do, a journal in its bore."""
