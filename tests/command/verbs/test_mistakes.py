"""What a command cannot do is one line that says why and what to do; no file is left behind."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
from commands import Command
from places import ROOT

from touchdown.master.common.errors import FAILED

TABLES = {  # what stands before the words of each line, and lines: words => what is said
    "": r"""
        runn x => there is no verb runn; did you mean run or rank; see touchdown --help
        run a b => touchdown run takes no argument b here; see touchdown run --help
        run a --durashon=3 => has no option --durashon=3; did you mean --duration; see touchdown run --help
        run a --zzz => touchdown run has no option --zzz; see touchdown run --help
        run a "b{LF}c{ESC}[31m" => touchdown run takes no argument
        run => see touchdown run --help
        --nosuch => see touchdown --help
        validate herz-impact => unknown case herz-impact; did you mean hertz-impact
        validate hertz-impact -o x => -o writes the page of all cases; name none of them
        figure 34 => the dissertation has no figure 34
        whirl rotor1-18000-225um --set rotor.speed=0 => drives no whirl; give --speed
        whirl rotor1-18000-225um --vary "housing_*.mass=-1:1:3:log kg" => START and STOP must be above 0
        whirl disk-caged-simplified => this needs a rotor of beam elements
    """,
    "check": """
        --as=bearing => --as: such options are for an FMU; name one
        cache --names=x => --names: such options are for an FMU; name one
        cache --call-timeout="1 s" => --call-timeout: such options are for an FMU; name one
        --sample-time="1 s" => --sample-time: such options are for an FMU; name one
    """,
    "compare": "=> a comparison needs a scene",
    "compare disk-caged-simplified": """
        --of scheme => there is no comparison of scheme; did you mean schemes
        --schemes hold,interfaces => unknown scheme interfaces; did you mean
        --schemes hold,,interface => a name is missing between the commas
        --macro-steps "5,20 m" => --macro-steps
        --quiet --macro-steps "20 ms" => 20000 us is longer than what is compared
        --wanted "1 s" => --wanted
        --set run.scheme=hold => use --schemes
        --set run.macro_step=1e-5 => use --macro-steps
        --set run.duration=1 => use --duration
        --set rotor.weight=1 => no variable weight
        --of models --schemes hold => --schemes does not go with --of models, which takes
        --of models --macro-steps "5 us" => in-process; set run.macro_step, that of its runs, instead
        --of bearings --duration "9 ms" => in-process; set run.duration, that of its runs, instead
        --of modes => has no flexible rotor
        --of stability => has scenes of its own
        --of bearings --bearings 6000 => 6000 has a bore of 10 mm
        --of bearings --bearings 601 => there is no bearing 601; did you
    """,
    "compare rotor1-9000 --of modes": """
        --modes 3,99 => modes = 99 must be from 2 (rigid) to 40
        --modes 3,1 => 1 is less than 2, the rigid modes per plane
        --modes 0 => all modes are the reference
        --modes 3,,5 => 'nothing' is not a whole number
        --modes 3.5 => '3.5' is not a whole number
        --macro-steps "2,5 us" => modes are compared at one macro step
        --set rotor.modes=3 => --set rotor.modes: compare sets it itself; use --modes
    """,
    "compare --of stability": """
        --set rotor.mass=1 => --set does not go with --of stability
        --cases bounces => there is no case bounces; did you mean bounce
    """,
    "amb-margins disk-caged-relevitated": """
        --amplitude "1 um" => amplitude needs measure (--measure, measure=True)
    """,
    "rotor": """
        disk-caged-simplified => is the FMU rigid_rotor; this needs a rotor of beam elements
        rotor1-9000 --support "A=1 MN/m" => --support is for rotors; rotor1-9000 is a scene
        rotor_I --load 2 => --load is for scenes; rotor_I is a rotor
        rotor_I --set amb_A.damping=1 => --set is for scenes; rotor_I is a rotor
        rotor1-9000 --set amb_A.dampin=1 => did you mean damping
        rotor1-9001 => there is no rotor called rotor1-9001; did you mean rotor1-9000
        bushing => there is no rotor called bushing
        nowhere.toml => cannot read nowhere.toml: No such file
        rotor_I --speed "3 kg" => --speed = '3 kg' has the unit kg
        rotor_I --modes 1 => modes = 1: Rotor I has 40 modes per plane; ask for 2 (rigid) to 40
        rotor_I --modes 41 => modes = 41
        rotor_I --modes 2.5 => --modes 2.5 must be a whole number
        rotor_I -o /proc/nowhere => cannot write to /proc/nowhere
        rotor_II --support "amb_C=1 MN/m" => has no station amb_C; it has: A, B, amb_A, amb_B
        rotor_II --support amb_A=0 => --support amb_A 0 must be above 0
        rotor_II --support "amb_A=1 kg" => has the unit kg
        rotor_II --support amb_A => --support amb_A: write NAME=VALUE
    """,
    "import rotor": """
        {EXAMPLES}/pump_sections.csv --at A => --at A: write NAME=VALUE
        {EXAMPLES}/pump_sections.csv --at A=1,A=2 => --at A=2: A is there twice
        {EXAMPLES}/pump_sections.csv --at "A=1 m" => is not on the rotor pump_sections, which ends at 520 mm
        {EXAMPLES}/pump_sections.csv --at stress=1 => has a name that cannot be used
        {EXAMPLES}/pump_sections.csv --speed fast => --speed = 'fast' is not a number
        gone.csv => cannot read gone.csv
    """,
    "import foundation {EXAMPLES}/frame_matrices": """
        --at A=2,C=4 => seats are used from A on, none left out
        --at X=2 => --at X: there are: A, B, C, D
        --at A=9 => there is no node 9
        --at A=2 --damping 1 => --damping 1 must be from 0 to below 1
    """,
    "verdict disk-caged-simplified --set 'rotor.eccentricity=5 um'": """
        --grid "0 deg" => grid = 0 deg must be from 0.1 to 180 deg
        --grid 12 => grid = 687.549 deg must be from 0.1 to 180 deg; write "12 deg"
        --grid "4 mm" => it is measured in rad
        --set "rotor.unbalance_angle=1 m" => it is measured in rad
    """,
    "sweep --quiet disk-cageless-simplified --vary bearing.as_printed=0:1:3": "=> as_printed",
    "sweep --quiet disk-caged-simplified": """
        => nothing varies
        --vary rotor.weight=1,2 => no variable weight
        --vary rtor.mass=1,2 => no component rtor; did you mean rotor
        --vary mass=1,2 => write COMPONENT.VARIABLE
        --vary rotor.mass=1,light => rotor.mass = 'light' is not a number
        --vary "rotor.mass=1,2 mm" => measured in kg
        --vary rotor.mass=1,-2 => rotor.mass = -2 kg must be above 0 kg
        --vary "bearing.clearance=0.2,0 mm" => bearing.clearance = 0 m must be above 0 m
        --vary run.scheme=hold,held => unknown scheme held
        --vary run.duration=1,0 => run.duration = '0' must be above 0
        --vary rotor.mass=1 --jobs two => --jobs = 'two' is not a number
        --vary rotor.mass=1 --duration -1 => run.duration = '-1' must be above 0
        --sobol 8 => a sample needs a range
        --range rotor.mass=1:2 => add how many, such as --sobol 64
        --sobol 8 --latin 8 --range rotor.mass=1:2 => --latin and --sobol are
        --sobol 8 --range "rotor.mass 1:2" => write NAME=LOW:HIGH UNIT
        --sobol 8 --range rotor.mass=-2:-1 => rotor.mass =
        --latin 8 --range rotor.mass=1:2 --seed -1 => --seed -1 must be a whole number
        --tie rotor.mass=1,2 --tie rotor.x=1 => equally many values
        --tie rotor.mass=1,2 --vary rotor.mass=3 => rotor.mass varies twice
        --list no.csv => cannot read no.csv
        --vary rotor.mass=1,2 --over rotor.x => a map over rotor.x: it does not vary
        --vary rotor.mass=1,2 --pick peak_contact => did you mean peak_contact_force
        --vary rotor.mass=1,2 --pick *whril* => --pick *whril*: there is no such quantity
        --vary rotor.mass=1,2 --pick seats.A.whril => there is no such quantity
    """,
}


def mistakes() -> Iterator[tuple[str, str]]:
    """Words of the command, and what it says of them."""
    known = {"{EXAMPLES}": str(ROOT / "examples"), "{LF}": "\n", "{ESC}": "\x1b"}
    for head, table in TABLES.items():
        for line in table.strip().splitlines():
            words, says = f"{head} {line.strip()}".split("=>")
            for name, value in known.items():
                words = words.replace(name, value)
            yield words.strip(), says.strip()


@pytest.mark.parametrize(("words", "says"), list(mistakes()))
def test_a_mistake_is_one_line(words: str, says: str, command: Command) -> None:
    ended = command(*shlex.split(words))
    assert ended.status == FAILED
    assert says in ended.line
    assert ended.line.isprintable()
    assert not [path for path in Path.cwd().rglob("*") if path.is_file()]
