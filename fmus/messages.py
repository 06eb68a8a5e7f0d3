"""What an FMU says where a call is out of order: templates, as in `touchdown.modelkit.messages`."""

from __future__ import annotations

SETUP_LATE = "the experiment can be set up before initialisation only"
NO_START = "the start time is {time:g} s; it must be a finite number"
ENTERED_TWICE = "initialisation can be entered once; reset the FMU to start anew"
NOT_ENTERED = "initialisation must be entered before it is left"
STOPPED = "stopped before: {why}"
NOT_STARTED = "cannot step before initialisation is complete"
ENDED = "cannot step after the end"
APART = "cannot step from t = {time:.9g} s by {step:g} s; the last step ended at {end:.9g} s"
SET_LATE = "{names} cannot be set as {kind} now; parameters that are not tunable are fixed by then"
UNREADABLE = "{names} cannot be read as {kind}"
READ_EARLY = "{names} cannot be read before initialisation is entered; nothing is computed yet"
UNKNOWN = "value reference {number:d}"
FOREIGN_STATE = "the state to restore is not one of this FMU, or was changed"
FAILED_STATE = "restored a failed state"
