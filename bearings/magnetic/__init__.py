"""Parts of a magnetic bearing with a controller: magnets, amplifiers, sensors, and the control's
law.

`magnet` is the magnetic circuit of a coil and its force, `amplifier` what drives the current, `sensing`
what the controller sees, `law` a sampled PID with second-order sections. The models that are made of them
are `surroundings.amb_actuator` and `surroundings.amb_controller`. SI units.
"""
