"""Archives of arrays: what is damaged, hostile or too large is one line, before it takes memory."""

from __future__ import annotations

import io
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest

from touchdown.modelkit import archives
from touchdown.modelkit.archives import read_archive
from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.imports.arrays import read_folder


def headed(head: str) -> bytes:
    """An array's file with a head of its own and no values."""
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode()


def packed(path: Path, content: bytes, method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as target:
        target.writestr("M.npy", content)
    return path


HEADS = {
    "open": "{'descr':'<f8'",
    "objects": "{'descr':'|O','fortran_order':False,'shape':(2,)}\n",
    "no table": "[]\n",
    "short": "{'descr':'<f8','fortran_order':False,'shape':(9,)}\n",
    "beyond all memory": "{'descr':'<f8','fortran_order':False,'shape':(9999999,9999999)}\n",
}


@pytest.mark.parametrize("head", HEADS.values(), ids=HEADS)
def test_a_head_that_is_no_array_s(head: str, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match=r"M\.npz is damaged .*write it by numpy\.savez"):
        read_archive(packed(tmp_path / "M.npz", headed(head)))


def test_an_array_that_is_called_an_archive(tmp_path: Path) -> None:
    with (tmp_path / "M.npz").open("wb") as file:
        np.save(file, np.zeros(3))
    with pytest.raises(TouchdownError, match="is damaged or not an archive of NumPy"):
        read_archive(tmp_path / "M.npz")


def test_a_stream_that_is_damaged(tmp_path: Path) -> None:
    numbers = io.BytesIO()
    np.save(numbers, np.random.default_rng(1).normal(size=500))
    content = bytearray(packed(tmp_path / "M.npz", numbers.getvalue()).read_bytes())
    content[300:310] = bytes(10)
    (tmp_path / "M.npz").write_bytes(content)
    with pytest.raises(TouchdownError, match="is damaged"):
        read_archive(tmp_path / "M.npz")


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_a_method_whose_pieces_have_no_bound(method: int, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match="by another method than deflate"):
        read_archive(packed(tmp_path / "M.npz", bytes(99), method))


def test_an_archive_that_swells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archives, "MAX_BYTES", 1_000_000)
    np.savez_compressed(tmp_path / "M.npz", M=np.zeros((1000, 1000)))
    with pytest.raises(TouchdownError, match="would unpack to 8 MB, more than 1 MB"):
        read_archive(tmp_path / "M.npz")


def test_a_matrix_of_few_entries_that_would_fill_memory(tmp_path: Path) -> None:
    (tmp_path / "M.mtx").write_text(
        "%%MatrixMarket matrix coordinate real general\n90000 90000 1\n1 1 1.0\n"
    )
    with pytest.raises(TouchdownError, match=r"M\.mtx would fill 64800 MB"):
        read_folder(tmp_path, ("M",))
