"""Magnetic bearings with controllers in a machine's scene, as text: wiring, events, settings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ...master.common.text import HZ, MM
from .machine_design import CURRENT, FLUX, SWUNG, Design, Levitation, Support
from .mount_rules import heading

OFF, ON = "20 ms", "220 ms"
AXES = (1, 2)  # of a bearing
UNFIT = (
    "--controller: a loop is unstable or leaves zone A up to the speed (exit status 2); the files are "
    "written, to go on from"
)


def controller(bearing: Support) -> str:
    """The component that controls a magnetic bearing."""
    return bearing.component.replace("amb", "controller", 1)


def controlled_head(d: Design, levitation: Levitation) -> Iterator[str]:
    """What stands before all tables: what was found, and who controls whom."""
    if levitation.about:
        yield from ('about = """', *levitation.about, '"""')
    pairs = ", ".join(f'["{controller(s)}", "{s.component}"]' for s in d.magnetic)
    yield f'zero = "{OFF}"  # results count times from here, events from the start of the run'
    yield f"control = [{pairs}]"
    if levitation.sensors:
        seen = zip(d.magnetic, levitation.sensors, strict=True)
        looks = ", ".join(f'["{s.component}.sensor", "rotor.{one}"]' for s, one in seen)
        yield f"sense = [{looks}]"


def controlled_events(d: Design) -> Iterator[str]:
    """The drop, and the attempt to levitate the rotor again."""
    for time, what in ((OFF, "off"), (ON, "on")):
        for s in d.magnetic:
            yield from ("", "[[event]]", f'time = "{time}"', f'what = "{controller(s)}: {what}"')


def controlled_text(d: Design, levitation: Levitation) -> Iterator[str]:
    """What all of them share: magnets, amplifiers, sensors, then the law."""
    one, load = levitation.magnets, f"{levitation.magnets.load:.4g} N"
    yield from (
        "",
        f"# -- the magnetic bearings: {load} on the one that has most",
        "",
        heading([s.component for s in d.magnetic]),
        f'magnet.gap = "{one.gap * MM:g} mm"  # twice the clearance',
        f'magnet.area = "{1e6 * one.area:g} mm2"  # of a pole: at {FLUX:g} T an axis pulls '
        f"{one.reserve:g} times that load, mu0 F/(B2 cos(pole_angle))",
        f"magnet.turns = {one.turns}  # make {FLUX:g} T at the current limit: 2 B gap/(mu0 i)",
        f'magnet.flux_limit = "{FLUX:g} T"  # where the iron saturates',
        f'amplifier.current_limit = "{CURRENT:g} A"  # of the amplifier at hand',
        f'amplifier.bias = "{0.5 * CURRENT:g} A"  # half of it, the same reserve up and down',
        f'supply.voltage = "{one.voltage:g} V"  # w L i0 + R i, swings a current by the bias at '
        f"{HZ * one.swung:.4g} Hz: {HZ * SWUNG:g} Hz, or twice the speed",
        f'sensing.range = "{one.gap * MM:g} mm"',
    )
    if levitation.sensors:
        yield 'sensing.at = "sensor"  # of the rotor, beside the magnets'
    yield f'sample_time = "{1e6 * levitation.period:g} us"  # the longest of 100, 50, 25 us with zone A'
    yield from ("", heading([controller(s) for s in d.magnetic]))
    yield f'limit = "{0.5 * CURRENT:g} A"  # the bias: beyond it one coil is empty'
    yield f'capture.radius = "{0.5 * d.clearance * MM:g} mm"  # half the clearance'
    if levitation.controller is not None:
        yield from _law(levitation)


def _law(levitation: Levitation) -> Iterator[str]:
    """Gains and sections."""
    assert levitation.controller is not None
    found, made_for = levitation.controller, levitation.controller.bearing
    stiffness, damping, _ = found.shape
    factors = f"k_s {1e-3 * made_for.displacement_factor:.4g} kN/m, k_i {made_for.current_factor:.4g} N/A"
    reasons = {
        "proportional": f"leaves {stiffness:.3g} |k_s|: {factors}",
        "derivative": f"{damping:.3g} of critical, of {made_for.mass:.4g} kg on that",
        "filter": "rad/s, where the derivative ends",
        "integral": "holds another load; its rate is 0.05 of the natural frequency",
    }
    for name, value in found.gains.items():
        yield f"gain.{name} = {value:.6g}  # {reasons[name]}"
    for n, section in enumerate(found.sections, 1):
        zero, pole = (f"{HZ * w:.4g} Hz" for w in (section.zero, section.pole))
        yield (
            f"# section {n}: zeros at {zero}, damping ratio {section.zero_damping:.3g}; poles at {pole}, "
            f"{section.pole_damping:.3g}"
        )
        table = _inline(section.coefficients(levitation.period))
        yield from (f'"channel[{axis}].section[{n}]" = {table}' for axis in AXES)


def _inline(values: Mapping[str, float]) -> str:
    return f"{{ {', '.join(f'{name} = {value:.12g}' for name, value in values.items())} }}"
