"""Results that FMUs carry with them are compared, and what cannot be compared is not counted."""

from __future__ import annotations

import zipfile
from pathlib import Path

import fmpy
import pytest

from touchdown.validation import bodies, references
from touchdown.validation.case import UnavailableError, Verdict


@pytest.mark.parametrize(("end", "verdict"), [("2", Verdict.AGREES), ("2.001", Verdict.DIFFERS)])
def test_published_results_are_compared(tmp_path: Path, end: str, verdict: Verdict) -> None:
    """Of an FMU that tells how much time it was stepped through."""
    if bodies.COMPILER is None or fmpy.platform != bodies.PLATFORM:
        pytest.skip(f"needs a C compiler for {bodies.PLATFORM}")
    path = bodies.fmu(bodies.compiled(tmp_path))
    results = references.RESULTS.format("body")
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr(results, f"time,elapsed,v,note\n0,0,0,on\n1,1,0,on\n2,{end},0,off\n")
    rows = references.rows_in(tmp_path)
    assert [row.quantity for row in rows] == ["FMI 2 body, elapsed, the worst of 3"]
    assert {references.reference_fmus.verdict(row) for row in rows} == {verdict}


@pytest.mark.parametrize(
    ("folder", "said"), [("", "set TOUCHDOWN_REF"), ("none", "is no folder"), (".", "no FMU in")]
)
def test_without_fmus_it_is_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str, said: str
) -> None:
    monkeypatch.setenv(references.VARIABLE, str(tmp_path / folder) if folder else "")
    with pytest.raises(UnavailableError, match=said):
        references.reference_fmus.rows()
