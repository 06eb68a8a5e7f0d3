"""Magnetic bearings: `amb` with a simple law of its own, `amb_actuator` for a controller, `amb_controller`.

`amb_axial` is the actuator along the shaft. `dc_link` feeds actuators. `magnet` is the magnetic circuit
of a coil and its force, `amplifier` what drives the current, `sensing` what is seen of the rotor, `law`
a sampled PID with second-order sections, `levitation` when a controller acts, `state_space` one whose
law is in a file (`law_file`), `linear` all of it for small motion. SI units.
"""
