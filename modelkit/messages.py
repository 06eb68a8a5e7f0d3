"""Messages of a running model that cannot go on.

Templates for `str.format`, kept to what C's printf can say, too: plain texts, numbers as `g` or `.9g`,
whole numbers as `d`. The Python instance and the native FMUs (`fmus.native`) speak from the same ones.
"""

from __future__ import annotations

# bounds of one variable; unit: with a space before it, or empty
NOT_FINITE = "{name} = {value:g} is not a finite number"
NOT_ABOVE = "{name} = {value:g}{unit} must be above {bound:g}{unit}"
TOO_SMALL = "{name} = {value:g}{unit} must be at least {bound:g}{unit}"
TOO_LARGE = "{name} = {value:g}{unit} must be at most {bound:g}{unit}"

# macro steps; time and step in s
NO_STEP = "cannot step from t = {time:.9g} s by {step:g} s; the step must be positive"
BAD_INPUT = "input {name} is {value:g} at t = {time:.9g} s; look at the component that feeds it"
BAD_LOAD = (
    "the load at t = {time:.9g} s is not a finite number; look for an input or a parameter that is out of "
    "all proportion"
)
TOO_MANY_STEPS = (
    "more than {most:d} micro-steps within one macro step of {step:g} s at t = {time:.9g} s; "
    "take a smaller macro step or a larger interface.tolerance"
)
TOO_LONG_STEP = (
    "the macro step of {step:g} s at t = {time:.9g} s is longer than sample_time, from sample to sample; "
    "take a smaller one"
)
ROW_OFF = (
    "at t = {time:.9g} s the rotor presses the inner ring off its row of balls, to the side where that has "
    "no shoulder; turn the row round (arrangement: single and tandem carry a shaft pushed in +z, single "
    "reversed and tandem reversed one pushed in -z), or take a pair back to back or face to face"
)
TOO_HOT = (
    "at t = {time:.9g} s heat runs away in the bearing: a part is 240 K warmer than at the start, at which "
    "steel is tempered where it starts at 20 C; take more play or less preload, less drag "
    "(rolling.resistance, friction), or let more heat out (heat.shaft_conductance, "
    "heat.housing_conductance)"
)
GAVE_UP = "the model's code gave up at t = {time:.9g} s; there may be no memory left"
UNRESOLVED = (
    "the motion inside cannot be resolved at t = {time:.9g} s with a macro step of {step:g} s; take a "
    "smaller macro step, or look for a contact that starts with a deep overlap"
)
TOO_FAST = (
    "the carrier's way in its mount cannot be resolved at t = {time:.9g} s with a macro step of {step:g} "
    "s: film, stop or slides act too fast. Take a macro step of {smaller:g} s; where that is refused too, "
    "look for a film.clearance that the carrier uses up"
)
