"""Which bodies the figures of a run are told of, and which of them a driver moves: from the joints and beams that tie them.
Called by verdict.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import decay
import quantities


def _tables(run, key):
    found = run.scene.get(key) or {}
    return {name: table for name, table in found.items() if isinstance(table, dict)} if isinstance(found, dict) else {}


def _ends(tie):
    return [body for body in tie.get("bodies") or [] if body != "earth"]


def _reached(start, ties, barred=()):
    """All bodies that ties lead to from one, itself included; the earth ties nothing to anything."""
    found, ahead = {start}, [start]
    while ahead:
        body = ahead.pop()
        more = {end for tie in ties if body in (ends := _ends(tie)) for end in ends} - found - set(barred)
        found |= more
        ahead += more
    return found


def _ties(run):
    return [*_tables(run, "joints").values(), *_tables(run, "beams").values()]


def _rotors(run):
    """(bodies that take the loads of rotors, bodies that turn with them)."""
    joints, carry, spinning = _tables(run, "joints"), set(), set()
    for rotor in (_tables(run, "rotors") or {"": run.scene.get("rotor") or {}}).values():
        if isinstance(rotor, dict):
            bearing = joints.get(rotor.get("joint")) or {}
            carry |= {body for body in [rotor.get("body"), *_ends(bearing)] if body}
            if ends := bearing.get("bodies"):
                spinning |= _reached(ends[-1], [tie for tie in _ties(run) if tie is not bearing], ends[:-1])
    return carry, spinning


def spinning(run):
    """Bodies that turn with rotors, whose attitude is the azimuth once more."""
    return _rotors(run)[1]


def told(run):
    """(bodies, of the headline): those whose motions say something, in the order of the columns. Of bodies that joints tie to a rotor the first that does not
    turn with it stands for all, and where there are rotors the headline is of these alone. Of bodies that are fixed to each other the first stands for all."""
    carry, spinning = _rotors(run)
    rotors = bool(quantities.rotors_of(run.columns))
    fixed = [joint for joint in _tables(run, "joints").values() if joint.get("type") == "fixed"]
    found, carriers, done = [], [], set()
    for body in quantities.bodies_of(run.columns):
        if body in done or body in spinning:
            continue
        tied = _reached(body, _ties(run))
        if rotors and (tied & carry or not carry):
            carriers.append(body)
        else:
            tied = _reached(body, fixed)
        done |= tied
        found.append(body)
    return found, carriers or found


def foundations(run):
    """Joints that hold a body fast to the earth."""
    return [name for name, joint in _tables(run, "joints").items() if joint.get("type") == "fixed" and "earth" in (joint.get("bodies") or [])]


def adrift(run):
    """Bodies that float with nothing to keep their place: neither lines nor springs, nor a way to the earth by joints and beams."""
    held = {body for line in _tables(run, "moorings").values() for body in (line.get("body"), line.get("anchor_body")) if body}
    held |= {springs["body"] for springs in (run.scene.get("sea") or {}).get("matrices") or [] if springs.get("stiffness")}
    held |= {body for tie in _ties(run) if "earth" in (tie.get("bodies") or []) for body in _ends(tie)}
    floats = (run.scene.get("sea") or {}).get("model") not in (None, "none")
    return {body for body in quantities.bodies_of(run.columns) if floats and not _reached(body, _ties(run)) & held}


def towed(run):
    """Bodies that a joint to the earth gives a motion, which need not come to rest, and those tied to them."""
    driven = [joint for joint in _tables(run, "joints").values() if "earth" in (joint.get("bodies") or []) and decay.is_driven(joint)]
    return {body for joint in driven for end in _ends(joint) for body in _reached(end, _ties(run))}
