from ctypes import CDLL, Structure, c_void_p
from typing import Any

fmi2False: int
fmi2True: int
fmi2CoSimulation: int

fmi2CallbackLoggerTYPE: Any
fmi2CallbackAllocateMemoryTYPE: Any
fmi2CallbackFreeMemoryTYPE: Any

class fmi2CallbackFunctions(Structure):
    logger: Any
    allocateMemory: Any
    freeMemory: Any

class FMU2Slave:
    component: c_void_p | None
    guid: str
    dll: CDLL

    def __init__(
        self, *, guid: str, modelIdentifier: str, unzipDirectory: str, instanceName: str
    ) -> None: ...
    def setupExperiment(
        self, tolerance: float | None = ..., startTime: float = ..., stopTime: float | None = ...
    ) -> int: ...
    def enterInitializationMode(self) -> int: ...
    def exitInitializationMode(self) -> int: ...
    def terminate(self) -> int: ...
    def freeInstance(self) -> None: ...
    def doStep(self, currentCommunicationPoint: float, communicationStepSize: float) -> int: ...
    def fmi2Instantiate(
        self,
        instanceName: bytes,
        fmuType: int,
        guid: bytes,
        resourceLocation: bytes,
        callbacks: Any,
        visible: int,
        loggingOn: int,
    ) -> c_void_p | None: ...
    def fmi2FreeInstance(self, c: c_void_p | None) -> None: ...
    def fmi2GetFMUstate(self, c: c_void_p | None, FMUstate: Any) -> int: ...
    def fmi2SetFMUstate(self, c: c_void_p | None, FMUstate: c_void_p) -> int: ...
    def fmi2FreeFMUstate(self, c: c_void_p | None, FMUstate: Any) -> int: ...
    def __getattr__(self, name: str) -> Any: ...
