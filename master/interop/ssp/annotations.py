"""What stands in annotations of a written package: steps, where each tool looks for them, and the scene.

OMSimulator reads the first annotation of the system and refuses any at the root of the structure, or in its
components. Its Python interface takes the master's step from attributes, its command line from an element
inside; both are there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

from touchdown.master.coupling.bonds.bond import Bond
from touchdown.master.interop.ssp.names import MASTER_ANNOTATION, SCENE_ANNOTATION, STEP_ANNOTATION
from touchdown.master.scene.run_spec import END, RunSpec
from touchdown.master.scene.scene import Scene

OMS_DEFAULT = "oms_ma_default"  # the master that OMSimulator gives components that name none
OMS_TOLERANCE = "0.0001"  # OMSimulator's own; a master with fixed steps makes no use of it


def write_hint(component: Element, step: float) -> None:
    """The macro step (s) of a component that takes several of the system's in one."""
    SubElement(_annotation(component, STEP_ANNOTATION), "osp:StepSizeHint", {"value": repr(step)})


def write_steps(experiment: Element, step: float) -> None:
    """The macro step (s) for libcosim, in the default experiment."""
    algorithm = SubElement(_annotation(experiment, STEP_ANNOTATION), "osp:Algorithm")
    SubElement(algorithm, "osp:FixedStepAlgorithm", {"baseStepSize": repr(step)})


def write_master(system: Element, step: float) -> None:
    """The macro step (s) for OMSimulator; it must be the system's first annotation."""
    told = SubElement(_annotation(system, MASTER_ANNOTATION), "oms:Annotations")
    attributes = {"name": OMS_DEFAULT, "method": "oms_ma", "fixedStepSize": repr(step)}
    information = SubElement(
        told, "oms:SimulationInformation", {**attributes, "relativeTolerance": OMS_TOLERANCE}
    )
    fixed = {"description": "oms-ma", "stepSize": repr(step), "relativeTolerance": OMS_TOLERANCE}
    SubElement(information, "oms:FixedStepMaster", fixed)


def write_scene(
    system: Element, scene: Scene, declared: Sequence[Bond], there: Callable[[str], str]
) -> None:
    """What a scene says beyond its structure, and the bonds that it declares.

    there(name): what COMPONENT[.VARIABLE] is called there.
    """
    details = {
        "title": scene.title,
        "about": scene.about.strip(),
        "zero": there(scene.zero) if scene.zero else "",
        "energy_scale": " ".join(map(there, scene.energy_scale)),
        **_run(scene.run, there),
    }
    stated = {key: value for key, value in details.items() if value}
    note = SubElement(_annotation(system, SCENE_ANNOTATION), "touchdown:Scene", stated)
    for name, spec in scene.components.items():
        for here, own in spec.names.items():
            SubElement(note, "touchdown:Name", {"component": there(name), "name": here, "own": own})
        for changed in spec.own:
            SubElement(note, "touchdown:Changed", {"component": there(name), "name": changed})
    for bond in declared:
        wires = {"force": bond.force, "position": bond.position, "velocity": bond.velocity}
        inputs = {kind: there(c.target_name) for kind, c in wires.items() if c}  # each has one source
        SubElement(note, "touchdown:Bond", inputs)


def _run(run: RunSpec, there: Callable[[str], str]) -> Mapping[str, str]:
    return {
        "scheme": run.scheme.name,
        "bonds": run.bonds,
        "tolerance": repr(run.tolerance),
        "record_every": str(run.record_every),
        "record": ",".join(map(there, run.record)),
        "record_also": ",".join(map(there, run.record_also)),
        "record_arrays": str(run.record_arrays).lower(),
        "warn_residual": repr(run.warn_residual),
        "stop_residual": repr(run.stop_residual),
        "whirl_halvings": str(run.whirl_halvings),
        "impact_step": repr(run.impact_step),
        **({} if run.until == END else {"until": run.until}),
    }


def _annotation(element: Element, kind: str) -> Element:
    """A new annotation of `element`."""
    annotations = element.find("ssd:Annotations")
    if annotations is None:
        annotations = SubElement(element, "ssd:Annotations")
    return SubElement(annotations, "ssc:Annotation", {"type": kind})
