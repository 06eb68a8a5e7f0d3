from typing import Any

class FMU3Slave:
    component: Any
    dll: Any
    def __init__(self, **settings: Any) -> None: ...
    def instantiate(self, **settings: Any) -> None: ...
    def __getattr__(self, name: str) -> Any: ...

fmi3ValueReference: Any
fmi3LogMessageCallback: Any
fmi3IntermediateUpdateCallback: Any
