# Types of what the project uses of fmpy, which ships none.
from pathlib import Path
from typing import Any

platform: str
sharedLibraryExtension: str

calloc: Any
free: Any

def read_model_description(filename: str | Path, validate: bool = ...) -> Any: ...
def __getattr__(name: str) -> Any: ...
