"""How a macro step ended; below zero, its code raised an error."""

OK = 0
BAD_INPUT = 1  # an input is not a finite number
STEP_UNDERFLOW = 2  # the motion cannot be resolved
TOO_MANY_STEPS = 3  # it would take too long
BAD_LOAD = 4  # what it hands over is not a finite number
TOO_LONG_STEP = 5  # it holds more than one sample
ROW_OFF = 6  # the rotor has pressed the inner ring off its rows of balls
TOO_FAST = 7  # slides, stop or film of a mount act too fast for it
TOO_HOT = 8  # a bearing's parts are warmer than their material bears
