"""Names of the formats: namespaces, files, and the annotations that are read beside the standard's own."""

from __future__ import annotations

_STANDARD = "http://ssp-standard.org/SSP1/SystemStructure"
NAMESPACES = {
    "ssd": f"{_STANDARD}Description",
    "ssc": f"{_STANDARD}Common",
    "ssv": f"{_STANDARD}ParameterValues",
    "ssm": f"{_STANDARD}ParameterMapping",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
    "touchdown": "urn:touchdown-cosim:scene",
}
REALS = ("Real", "Float64", "Float32")  # elements of a connector's or a parameter's type, 1.0's and 2.0's
INTEGERS = ("Integer", *(f"{sign}Int{bits}" for bits in (8, 16, 32, 64) for sign in ("", "U")))
HEART = "SystemStructure.ssd"
RESOURCES = "resources"
STEP_ANNOTATION = "com.opensimulationplatform"  # holds the macro step for libcosim
MASTER_ANNOTATION = "org.openmodelica"  # holds it for OMSimulator
SCENE_ANNOTATION = "touchdown-cosim.scene"  # what a scene says beyond its structure
