"""The verbs of the command `touchdown`, in the groups and the order of its help."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from ..api.fmus import check
from ..api.machines import (
    animate,
    diff,
    export,
    import_foundation,
    import_mount,
    import_rotor,
    new,
    report,
    view,
)
from ..api.run import run
from ..api.studies import amb_margins, compare, figure, rank, survival, sweep, verdict, whirl
from ..options import Verb
from . import fmus, machines, runs, studies
from .scenes import (
    before_drop,
    before_run,
    chosen_scene,
    grid,
    points,
    scene_or_earlier,
    scene_or_state,
    set_scene,
)


def _show_paths(paths: object) -> int:
    """Print where the results are."""
    print("\n".join(map(str, paths if isinstance(paths, list) else [paths])))
    return 0


# whole command lines, as they are typed and as help shows them
EXAMPLES = """
touchdown new my-machine --rotor rotor_II --bearings 7014
touchdown new my-machine --rotor rotor.toml --bearings 7014 --at A,B --amb A,B --speed "9000 rpm"
touchdown new my-disk --mass "60 kg" --bearings 6014
touchdown new my-levitated-rotor --rotor rotor_II --bearings 7014 --controller
touchdown scenes
touchdown scenes rotor1-9000
touchdown scenes disk-caged-simplified --variables bearing
touchdown scenes --quantities
touchdown catalogue --bore "70 mm"
touchdown catalogue 7014
touchdown catalogue 7014 --thrust "2 kN" --arrangement "back to back" --preload "300 N"
touchdown rotor rotor_I
touchdown rotor rotor_II --support "amb_A=20 MN/m" --support "amb_B=20 MN/m" --speed "10000 rpm"
touchdown rotor my-rotor.toml --speed "12000 rpm" --modes 8 -o runs/my-rotor
touchdown rotor rotor1-9000 --set amb_*.stiffness=4e5 -o runs/stiffer
touchdown import rotor examples/pump_sections.csv -o runs/pump.toml
touchdown import rotor examples/pump_sections.csv --at "A=50 mm,B=17" --amb amb_A=7,amb_B=15
touchdown import mount examples/mount_loop.csv --slides 1 -o runs/mount.toml
touchdown import foundation examples/frame_matrices --at A=2,B=4 -o runs/frame.toml
touchdown run disk-caged-simplified
touchdown run disk-caged-simplified --swap bearing=detailed_caged -o runs/detailed
touchdown run rotor1-9000 --set "run.macro_step=10 us" --set "rotor.speed=12000 rpm"
touchdown run rotor1-18000-150um --in-process --set run.until=settled --duration "2 s"
touchdown run --from runs/disk-caged-simplified --duration "6 s"
touchdown run rotor1-9000 --in-process --spin-down "60 s" --set rotor.drag=0.1
touchdown run runs/sweep-rotor1-9000 --member 3
touchdown run runs/sweep-rotor1-9000 --worst peak_contact_force
touchdown diff runs/disk-caged-simplified runs/detailed
touchdown diff runs/rotor1-9000 runs/sweep-rotor1-9000/3
touchdown report runs/disk-caged-simplified
touchdown report runs/disk-caged-simplified -o runs/drop.html --pdf
touchdown report runs/disk-caged-simplified --short
touchdown animate runs/disk-caged-simplified -o runs/drop.gif
touchdown animate runs/disk-caged-simplified -o runs/drop.mp4
touchdown view runs/disk-caged-simplified
touchdown view runs/disk-caged-simplified -o runs/view.html
touchdown export runs/disk-caged-simplified --to mat
touchdown sweep disk-caged-simplified --vary "bearing.clearance=0.2,0.25,0.3 mm" --duration "0.1 s"
touchdown sweep rotor1-9000 --vary "housing_A.x0=0:150:4 um" --jobs 4 --pick "*whirl*"
touchdown sweep rotor1-9000 --sobol 64 --range "bearing_*.clearance=0.2:0.3 mm" --in-process
touchdown sweep rotor1-9000 --vary "rotor.unbalance_angle=0:345:24 deg" --jobs tcp://cluster:8786
touchdown sweep --from runs/levitated --vary "amb_*.shutdown_time=20:25:4 ms" --duration "20 ms"
touchdown verdict rotor1-18000-150um --duration "0.2 s" --in-process
touchdown verdict rotor1-18000-150um --duration "0.2 s" --macro-steps "10,20,40 us" --reference
touchdown whirl rotor1-18000-225um
touchdown whirl rotor1-18000-225um --speed "12000 rpm" --set "housing_*.damping=10000 N.s/m"
touchdown whirl rotor1-18000-225um --vary "housing_*.stiffness=2:250:12:log MN/m" -o runs/mounts
touchdown survival runs/sweep-rotor1-9000
touchdown survival runs/sweep-rotor1-9000 --limit "ball_force=1695 N" --drops 1:20
touchdown rank my-machine/required.toml --bearings "7014,6014,61914" --duration "0.2 s"
touchdown rank my-machine/required.toml --bearings "7014" --mount soft.toml --mount stiff.toml
touchdown rank my-machine/required.toml --at "A=7014,71914" --at "B=6014" --duration "0.2 s"
touchdown amb-margins disk-caged-relevitated
touchdown amb-margins rotor1-relevitated --speeds "0 rpm, 9000 rpm, 18000 rpm" -o runs/margins
touchdown compare disk-caged-simplified --schemes hold,velocity,interface --macro-steps "5,20,100 us"
touchdown compare disk-caged-simplified --of models --repeat 1 --duration "3 ms"
touchdown compare rotor1-9000 --of modes --modes 5,20
touchdown compare --of stability --cases bounce,mass-1 --schemes hold,interface
touchdown figure
touchdown figure 22 -o runs/figures
touchdown figure bearings --ensemble 1
touchdown figure all -o docs
touchdown validate
touchdown validate hertz-impact
touchdown validate -o docs
touchdown build my-rotor.toml
touchdown build simplified_caged rotor_I --modes 5 -o build/five-modes
touchdown build housing --native --target linux-x86_64,windows-x86_64 -o build/native
touchdown build --native examples/rubber_ring.py -o build/native
touchdown check
touchdown check my-bearing.fmu --as bearing --names my-names.toml
touchdown check amb_controller --as controller
touchdown check cache --unused-for 7
touchdown ssp rotor1-9000 --set run.scheme=jacobi-lead --set "run.macro_step=5 us" --outputs-only
touchdown ssp disk-caged-simplified --set run.scheme=jacobi-lead --outputs-only --native -o disk.ssp
touchdown ssp disk-caged-simplified --native --target linux-x86_64,windows-x86_64 -o disk.ssp
"""
SCENE = {"scene": chosen_scene}
_GROUPS = {
    "your machine": (
        Verb("new", new, machines.show_new, named=("bearings", "rotor", "force")),
        Verb("scenes", machines.show_scenes),
        Verb("catalogue", machines.show_catalogue),
        Verb("rotor", machines.show_rotors),
        Verb("import", machines.show_import, documented=(import_rotor, import_mount, import_foundation)),
    ),
    "run and look": (
        Verb(
            "run",
            run,
            runs.show_run,
            before=before_drop,
            output="runs/{SCENE}",
            defaults={"native": None, "pictures": True},
            builders={"scene": scene_or_earlier},
            left=runs.left_behind,
            in_place=True,
        ),
        Verb("diff", diff, runs.show_diff, output="runs/diff"),
        Verb("report", report, _show_paths),
        Verb("animate", animate, _show_paths),
        Verb("view", view, _show_paths),
        Verb("export", export, _show_paths),
    ),
    "studies": (
        Verb(
            "sweep",
            sweep,
            studies.show_sweep,
            before=studies.before_sweep,
            output="runs/sweep-{SCENE}",
            builders={"scene": scene_or_state, "variations": points},
        ),
        Verb(
            "verdict",
            verdict,
            studies.show_verdict,
            before=before_run,
            output="runs/verdict-{SCENE}",
            builders=SCENE,
        ),
        Verb(
            "whirl",
            whirl,
            studies.show_whirl,
            before=before_run,
            output="runs/whirl-{SCENE}",
            builders={"scene": set_scene, "variations": grid},
        ),
        Verb("survival", survival, studies.show_survival),
        Verb(
            "rank",
            rank,
            studies.show_rank,
            before=before_run,
            output="runs/rank-{SCENE}",
            named=("bearings",),
            builders=SCENE,
        ),
        Verb(
            "amb-margins",
            amb_margins,
            studies.show_margins,
            before=before_run,
            output="runs/amb-margins-{SCENE}",
            builders={"scene": set_scene},
        ),
        Verb(
            "compare",
            compare,
            studies.show_compare,
            before=studies.before_compare,
            named=("of",),
            output="runs/{OF}-{SCENE}",
            builders={"scene": set_scene},
        ),
    ),
    "the dissertation and other references": (
        Verb("figure", studies.show_figure, output="runs/figures", documented=(figure,)),
        Verb("validate", studies.show_validation),
    ),
    "FMUs and systems": (
        Verb("build", fmus.show_build, output="build"),
        Verb("check", fmus.show_check, documented=(check,)),
        Verb("ssp", fmus.show_ssp, output="{SCENE}.ssp", builders=SCENE),
    ),
}
GROUPS: Mapping[str, tuple[Verb, ...]] = {
    group: tuple(
        replace(v, examples=tuple(re.findall(f"^touchdown {v.name}\\b.*", EXAMPLES, re.M))) for v in verbs
    )
    for group, verbs in _GROUPS.items()
}
ALL: tuple[Verb, ...] = tuple(verb for group in GROUPS.values() for verb in group)
