"""What functor.cpp's numbers say about a constraint."""

import math

import orders
from forces import NEAR, biggest, dot, minus, text
from judge import distance, plural, size
from workshop import BadInput


def by_variant(rows):
    found = {}
    for variant, node, *row in rows:
        found.setdefault(int(variant), {})[int(node)] = row
    return found


def sphere(points):
    """(center, radius) through points, by least squares; None if there is
    none."""
    if len(points) < 5:
        return None
    rows = [[2 * c for c in p] + [1, dot(p, p)] for p in points]
    m = [[sum(r[i] * r[j] for r in rows) for j in range(5)] for i in range(4)]
    for i in range(4):
        pivot = max(range(i, 4), key=lambda r: abs(m[r][i]))
        m[i], m[pivot] = m[pivot], m[i]
        if abs(m[i][i]) < 1e-9:
            return None
        for r in range(4):
            if r != i:
                m[r] = [a - m[r][i] / m[i][i] * b for a, b in zip(m[r], m[i])]
    *center, k = (m[i][4] / m[i][i] for i in range(4))
    radius = math.sqrt(max(0, k + dot(center, center)))
    return (center, radius) if all(
        abs(math.dist(p, center) - radius) < 1e-7 for p in points) else None


def surface(v, moves):
    """What nodes are moved to. moves: (x and v before, x and v after)"""
    ends = [after[:3] for _, after in moves]
    planes = [d for d in range(3) if all(
        abs(p[d] - ends[0][d]) < NEAR for p in ends)]
    if len(planes) == 1 and len(ends) > 3:
        d = planes[0]
        if all(abs(b[e] - a[e]) < NEAR for b, a in moves for e in range(3)
               if e != d):
            return f"a plane at {'xyz'[d]} = {ends[0][d]:.4g} m"
        v.faults.append((f"nodes are moved along the plane {'xyz'[d]} = "
                         f"{ends[0][d]:.4g} m, not only to it",
                         "Change the coordinate normal to the plane alone."))
        return "a plane"
    ball = sphere(ends)
    if not ball:
        return "no plane and no ball"
    center, radius = ball
    off = max(biggest(minus(minus(a[:3], b[:3]), [
        dot(minus(a[:3], b[:3]), minus(a[:3], center)) / radius ** 2 * c
        for c in minus(a[:3], center)])) for b, a in moves)
    if off > 1e-6:
        v.faults.append(("nodes go to the ball, but not to the nearest point "
                         "of its surface", "Move a node along the line from "
                         "the center."))
    return f"a ball around {text(center)} m of radius {radius:.4g} m"


def read(v, where, numbers):
    before, once, twice = (by_variant(numbers[name]) for name in (
        "before", "once", "twice"))
    for k, rows in once.items():
        if any(x != x for row in rows.values() for x in row):
            if k == 5:
                v.faults.append((
                    "it writes NaN for a node at the center of the ball",
                    "There is no direction: choose one, such as up."))
            else:
                raise BadInput(f"{where}: writes NaN")
    nan = {k for k, rows in once.items() if any(
        x != x for row in rows.values() for x in row)}
    used = [k for k in before if k not in nan and k < 7 and k in once]
    removed = sum(len(before[k]) - len(once.get(k, {})) for k in before)
    more = sum(len(once[k]) - len(twice.get(k, {})) for k in once)
    start = before[0]
    pins = [i for i in start if all(
        i in once[k] and distance(once[k][i][:3], start[i][:3]) < NEAR
        for k in used) and any(before[k][i] != once[k][i] for k in used)]
    moves = [(before[k][i], row) for k in used for i, row in once[k].items()
             if i not in pins and distance(before[k][i], row) > NEAR]
    placed = [(b, a) for b, a in moves if distance(b[:3], a[:3]) > NEAR]
    is_a = []
    if pins:
        at = ", ".join(text(start[i][:3]) for i in pins[:3])
        is_a.append(f"a pin of {plural(len(pins), 'node')}: {at}"
                    + (", ..." if len(pins) > 3 else ""))
        if any(biggest(once[k][i][3:]) > NEAR for k in used for i in pins):
            v.faults.append(("pinned nodes keep a velocity", "Set the velocity "
                             "of a pinned node to 0, too."))
    if placed:
        is_a.append(surface(v, placed))
    elif moves:
        is_a.append("a change of velocities alone")
    if removed:
        is_a.append("a tear: it removes nodes")
    v.is_a = ("it is " + " and ".join(is_a) if is_a else "it does nothing on "
              "the cloths tried here: flat, waving, 0.3 to 1 m below the pins")
    again(v, used, once, twice, more)
    velocities(v, placed)
    rest(v, numbers, before, once, twice, removed, used)
    if moved := [(before[k][i][:3], row[:3]) for k in used if k
                 for i, row in once[k].items()
                 if distance(before[k][i][:3], row[:3]) > NEAR]:
        v.data["call"] = moved


def again(v, used, once, twice, more):
    off = max((distance(once[k][i], row) for k in used if k in twice
               for i, row in twice[k].items()), default=0)
    if more:
        v.faults.append((
            f"a second call removes {more} more: the loop skips nodes",
            "After remove_node(n) another node has its index: look at this "
            "index again before you go on."))
    elif off > 1e-9:
        v.faults.append((
            f"a second call moves nodes by {size(off)} more: the first one "
            "does not reach what it wants",
            "Set position and velocity to what is wanted, not nearer to it."))
    v.facts.append(("a second call", "changes nothing" if not more
                    and off < 1e-9 else "changes more"))


def velocities(v, placed):
    into = along = up = 0.0
    for b, a in placed:
        d = minus(a[:3], b[:3])
        n = [x / math.hypot(*d) for x in d]
        was, now = b[3:], a[3:]
        if dot(was, n) < 0:
            into = min(into, dot(now, n))
            up = max(up, -dot(now, n) / dot(was, n))
        side = minus(minus(now, was), [dot(minus(now, was), n) * x for x in n])
        along = max(along, math.hypot(*side))
    if into < -NEAR:
        v.faults.append((f"nodes on the surface keep a velocity into it, up to "
                         f"{-into:.3g} m/s: they enter it again in each step",
                         "Take away the part of the velocity along the normal "
                         "of the surface."))
    if placed:
        words = []
        if up > NEAR:
            words.append(f"nodes bounce, with up to {up:.3g} of their speed")
        if along > NEAR:
            words.append("the part along the surface changes by up to "
                         f"{along:.3g} m/s")
        v.facts.append(("velocities", "; ".join(words) or "the part along the "
                        "surface is kept, the part normal to it is 0"
                        if into > -NEAR else "not reset"))
        if up > 1 + NEAR:
            v.faults.append(("a bounce adds energy", "A node must not leave "
                             "faster than it came."))


def rest(v, numbers, before, once, twice, removed, used):
    stiff = [row[len(rows):][::2] for row, rows in zip(numbers["data"],
                                                       twice.values())]
    if set(sum(map(list, twice.values()), [])) - set(range(81)) or any(
            K != 100 for row in stiff for K in row):
        v.faults.append(("it changes masses or springs", "A constraint changes "
                         "positions and velocities, or removes nodes."))
    coupled = any(distance(row, once[6][i]) > NEAR for i, row in
                  once[2].items() if i != 40 and i in once.get(6, {}))
    v.facts.append(("nodes", "each is treated by itself" if not coupled else
                    "what happens to one changes others"))
    moving = any(distance(row, once[7][i]) > NEAR
                 for i, row in once[2].items() if i in once.get(7, {}))
    v.facts.append(("time", "matters: it moves" if moving else
                    "does not matter"))
    gained = max((energy(before[k], once[k]) for k in used), default=0)
    v.facts.append(("kinetic energy", "never added by a call" if gained < NEAR
                    else f"a call adds up to {gained:.3g} J"))
    if removed:
        v.facts.append(("removal", f"{removed} nodes in 8 calls; the others "
                        "stay as they are" if not coupled else
                        f"{removed} nodes in 8 calls"))
        return
    o = orders.by_differences(numbers["verlet"])
    if o.order == o.order:
        v.facts.append(("order of Verlet with it", f"{o.order:.2f}: "
                        + ("kept" if o.order > 1.7 else "lost, as nodes "
                           "meet the surface within a step")))
    else:
        v.facts.append(("order of Verlet with it", "not measurable: runs with "
                        "smaller steps do not come closer to each other"))


def energy(before, once):
    return sum((.02 * (dot(a[3:], a[3:]) - dot(before[i][3:], before[i][3:])))
               for i, a in once.items())
