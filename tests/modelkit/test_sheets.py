"""Tables as spreadsheets, loggers and people of several countries write them: one reading, or one line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.modelkit.reader import TEXT, number
from touchdown.modelkit.sheets import rows

COLUMNS = {"travel": "m", "load": "N", "name": ""}
ALSO = {"weg": "travel", "traeger": "name"}
POINT = "travel [mm],load [N]\n0.5,1250\n12.25,-3e2\n"
COMMA = POINT.replace(",", ";").replace(".", ",")
READ = [(0.5e-3, 1250.0), (12.25e-3, -300.0)]


def read(content: str | bytes, tmp_path: Path, **how: Any) -> list[tuple[float, float]]:
    """Travel (m) and load (N) of the rows."""
    path = tmp_path / "my.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    found = rows(path, COLUMNS, ("travel", "load"), ALSO, **how)
    return [(row.get("travel", number("m")), row.get("load", number("N"))) for row in found]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("text", [POINT, COMMA, COMMA.replace(";", "\t"), POINT.replace(",", ";")])
def test_encodings_line_ends_and_decimal_marks(text: str, end: str, encoding: str, tmp_path: Path) -> None:
    text = text.replace("[mm]", "[\u00b5m]" if encoding == "cp1252" else "[mm]")
    scale = 1e-3 if encoding == "cp1252" else 1.0
    found = read(text.replace("\n", end).encode(encoding), tmp_path)
    assert found == [(pytest.approx(scale * travel), load) for travel, load in READ]


@pytest.mark.parametrize(
    "text",
    [
        f"My table\nmade;on;Monday\n\n{COMMA}",  # titles
        f"sep=;\n{COMMA}",
        f"# {POINT}",  # as numpy.savetxt writes a header
        f"# travel [um], load [kN]\n{POINT}",
        'travel [mm],load [N]\n"0,5","1250"\n"12,25","-3e2"\n',
        "travel,load\nmm,N\n0.5,1250\n12.25,-300\n",  # units below
        "travel;load\n[mm];[N]\n0.5;1250\n12.25;-300\n",
        "Weg / mm;Load in N;Tr\u00e4ger\n0,5;1.250;a\n12,25;-300;b\n",
        "travel [mm];load [N]\n0.5;1,250\n12.25;\u2212300\n",
        "travel [mm];load [kN]\n0.5;1.25\n12.25;-300 N\n",
        "travel [mm];load [N]\n0,5;1'250\n12,25;-300,0\n",
        "travel [mm];load [N]\n0,5;1 250\n12,25;-3D2\n",
        "travel [um];load [mN]\n500;1,250,000.0\n12,250.0;-300,000\n",
        ";travel [mm];load [N];;\n;0.5;1250;;\n;;;;\n;12.25;-300;;\n",
        "travel [mm];load [N]\n5.000e-01;1.250e+03\n1.225e+01;-3.000e+02\n",
        '""\ntravel [mm];load [N]\n0.5;1250\n12.25;-300\n',
    ],
)
def test_what_has_one_reading_is_read(text: str, tmp_path: Path) -> None:
    assert read(text, tmp_path) == [(pytest.approx(travel), pytest.approx(load)) for travel, load in READ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("travel [mm];load [N]\n1;1.250\n", "line 2: load = '1.250' may be 1.250 or 1250; write numbers"),
        ("travel [mm];load [N]\n1;1,250\n", "line 2: load = '1,250' may be 1250 or 1.250; write numbers"),
        ('travel [mm],load [N]\n"1,250",1\n', "line 2: travel = '1,250' may be 1250 or 1.250"),
        (
            "travel [mm];load [N]\n1;0.5\n0,5;2\n",
            "line 3: travel = '0,5' has a decimal comma, .*line 2: load",
        ),
        ("travel [mm];load [N]\n1;1.080.00\n", "line 2: load = '1.080.00' cannot be read as a number"),
        ("travel [mm];load [N]\n1;12.34,5\n", "line 2: load = '12.34,5' cannot be read as a number"),
        ("travel [mm],load [N]\n0,5,1,5\n", "line 2: has 4 cells, the header 2; part cells by semicolons"),
        ("travel,load\nmm,s\n1,2\n", "line 3: load = '2 s' has the unit s; it is measured in N"),
        ("travel [mm],load [N]\nmm,kN\n1,2\n", "line 2: load = 'kN' is not a number, nor the unit N"),
        ("travel,load [N]\n1,2\n", r"line 1: travel has no unit; write it as travel \[mm\]"),
        ("travel,load\nmm,N\n", "has no row below its header"),
        ("travel [mm],lod [N]\n1,2\n", r"line 1: the column 'lod \[N\]' is not known; did you mean load"),
        ("travel [mm],name\n1,2\n", "no column load; the header needs travel, load, and has travel"),
        ("travel [mm],Träge [N]\n1,2\n", "not known; did you mean traeger; columns are travel, load, name"),
        ("travel [mm],Höhe [N]\n1,2\n", "is not known; columns are travel, load, name"),
        ("A title\ntravel [mm],lod [N]\n1,2\n", "line 2: the column"),
        ("travel [mm],load [N],load [kN]\n1,2,3\n", "line 1: there are two columns load"),
        (b"PK\3\4...", "my.csv is a workbook of a spreadsheet program; save its sheet as CSV"),
        (b"travel [mm],load [N]\n1,\x81\n", "is not text in UTF-8, UTF-16 or Windows-1252; save it as CSV"),
    ],
)
def test_what_has_two_or_no_readings_is_one_line(text: str | bytes, says: str, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match=says) as caught:
        read(text, tmp_path)
    assert "\n" not in str(caught.value)


def test_other_columns_and_longer_names_may_be_there(tmp_path: Path) -> None:
    text = "time;travel left [mm];load cell 1 [N];note [x]\n1.5;0,5;1250;\n2.5;12,25;-300;up\n"
    assert read(text, tmp_path, others=True) == [(pytest.approx(x), force) for x, force in READ]
    with pytest.raises(TouchdownError, match="there are two columns travel; leave one"):
        read("travel [mm];travel raw [mm];load [N]\n1;1;2\n", tmp_path, others=True)


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_rows_have_the_units_of_their_header(mark: str, tmp_path: Path) -> None:
    path = tmp_path / "my.csv"
    lines = [["Free length [mm]", "name"], ["12.5", "a"], ["", ""], ["0.1 m", "1,5"], ["# none", ""]]
    path.write_text(
        "\n".join(mark.join(cells) for cells in lines).replace("1,5", '"1,5"'), encoding="utf-8"
    )
    found = rows(path, {"free_length": "m", "name": ""})
    assert [row.get("free_length", number("m")) for row in found] == [0.0125, 0.1]
    assert [row.get("name", TEXT) for row in found] == ["a", "1,5"]
    assert found[1].where == f"{path}, line 4: "


@pytest.mark.parametrize("cell", ['"30', '"3" 0'])
def test_a_quotation_mark_opens_no_row_below(cell: str, tmp_path: Path) -> None:
    path = tmp_path / "my.csv"
    path.write_text(f'name,load [N]\n{cell},1\n"b, c",2\nd",3\n', encoding="utf-8")
    with pytest.raises(TouchdownError, match=f"^{path}, line 2: a cell in quotation marks must end"):
        rows(path, COLUMNS)


def test_settings_are_any_names_with_a_dot_and_values_may_be_words(tmp_path: Path) -> None:
    path = tmp_path / "my.csv"
    text = (
        "Plan\nrotor.speed [rpm];run.scheme;bearing.preset\n9000;hold;6004\n1,5 rad/s;own.toml:a;6004-2RS\n"
    )
    path.write_text(text, encoding="utf-8")
    assert [list(row.values.values()) for row in rows(path, None)] == [
        ["9000 rpm", "hold", "6004"],
        ["1.5 rad/s", "own.toml:a", "6004-2RS"],
    ]
    path.write_text("speed\n9000\n", encoding="utf-8")
    with pytest.raises(
        TouchdownError, match="column 'speed' is not known; columns are settings, such as rotor"
    ):
        rows(path, None)
