"""What functor.cpp's numbers say about a force."""

import math

from judge import SPRINGS, distance, size, yes
from workshop import BadInput

NEAR = 1e-9


# ---- Lists of vectors, node after node

def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def nodes(f):
    return [f[k:k + 3] for k in range(0, len(f), 3)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def biggest(f):
    return max(map(abs, f), default=0)


def total(f):
    return [sum(p[d] for p in nodes(f)) for d in range(3)]


def factor(f, of):
    """r if f = r times `of`, else None."""
    r = dot(f, of) / dot(of, of) if dot(of, of) else 0
    return r if biggest(minus(f, [r * x for x in of])) < NEAR * max(
        1, biggest(f)) else None


def text(p):
    return "(" + ", ".join(f"{x if abs(x) > 1e-12 else 0:.4g}"
                           for x in p) + ")"


# ---- Forces

def spring_sum(x, weight):
    """On each node the sum of weight(K, l, L) u, where u leads to the other
    end and l = |u|; for the tangle of World.hpp."""
    f = [[0.0] * 3 for _ in x]
    for k, (i, j) in enumerate(SPRINGS):
        u = minus(x[j], x[i])
        w = weight(4 + k, math.hypot(*u), .7 + .1 * k)
        for d in range(3):
            f[i][d] += w * u[d]
            f[j][d] -= w * u[d]
    return sum(f, [])


def compressed(v, rows):
    """The spring of nodes 0 and 1, of lengths k L/4: K = 4, L = 0.7."""
    for k, row in list(enumerate(rows))[1:4]:
        pull, right = row[0] - rows[4][0], 4 * .7 * (k / 4 - 1)
        if abs(pull - right) < NEAR:
            continue
        if abs(pull) < NEAR:
            v.notes.append("springs that are compressed do not push: ropes")
        elif abs(pull + right) < NEAR:
            v.faults.append(("compressed springs pull, too: the sign of l - L "
                             "is lost", "Use K (l - L), negative if l < L."))
        else:
            v.faults.append((f"a spring compressed to {k}/4 of its length acts "
                             f"with {-pull:.4g} N, not {-right:.4g} N",
                             "Use K (l - L) for each length."))
        return


WRONG_SPRINGS = [
    (lambda k, l, _: k, "the rest length is forgotten: springs pull by K l, "
     "not by K (l - L)", "Use K (l - L) along the spring."),
    (lambda k, l, L: k * (l - L), "the direction is not of length 1: the force "
     "is K (l - L) u in place of K (l - L) u/l",
     "Divide the vector between the ends by its length."),
    (lambda k, l, L: k * (l - L) / l ** 2, "it is divided by the length twice",
     "Divide the vector between the ends by its length once."),
    (lambda k, l, L: k * (l * l - L * L) / l, "lengths are squared: norm and "
     "normSq are mixed up", "Use K (l - L), with l = norm(u)."),
]


def springs(v, part, x, masses):
    """What the part of a force that depends on K is."""
    right = spring_sum(x, lambda k, l, L: k * (l - L) / l)
    r = factor(part, right)
    if r is not None and abs(r - 1) < NEAR:
        return ("the springs, K (l - L) along each: equal to MassSpringForce "
                "to round-off")
    found = None
    if r is not None:
        found = (("springs push where they should pull: the sign is wrong",
                  "A stretched spring pulls the node to the other end.")
                 if abs(r + 1) < NEAR else
                 (f"the force of the springs is {r:.4g} times K (l - L)",
                  "Each spring acts on a node once, with K (l - L)."))
    for weight, words, advice in WRONG_SPRINGS:
        if factor(part, spring_sum(x, weight)) is not None:
            found = found or (words, advice)
    for power, words in ((-1, "divided by"), (1, "multiplied by")):
        scaled = [f * masses[k // 3] ** power for k, f in enumerate(right)]
        if factor(part, scaled) is not None:
            found = found or (f"the force of the springs is {words} the mass",
                              "Return the force in newtons; the step divides "
                              "by the mass.")
    lost = total(part)
    if not found and biggest(lost) > NEAR * biggest(part):
        found = (f"the forces of the springs add up to {text(lost)} N, not to "
                 "0: a spring pulls its two ends differently (Newton's third "
                 "law)", "Add up all edges of a node, each with its own K and "
                 "L, from the node to the other end.")
    if found:
        v.faults.append(found)
    return "springs of another law than K (l - L)"


def field(v, at_rest, heavy, moved, masses):
    """What acts on nodes at rest without springs."""
    f = nodes(at_rest)
    if biggest(minus(at_rest, moved)) > NEAR * biggest(at_rest):
        return "a force that depends on the place"
    a = [[c / m for c in p] for p, m in zip(f, masses)]
    if all(distance(a[0], p) < NEAR for p in a):
        if a[0][2] > 0 and a[0][0] == a[0][1] == 0:
            v.faults.append(("gravity points up: z points up, so the force is "
                             "-m g along z", "Return m * Point(0, 0, -g)."))
        return f"m times {text(a[0])} m/s^2, a gravity"
    if all(distance(f[0], p) < NEAR for p in f):
        if f[0][2] < 0 and f[0][0] == f[0][1] == 0:
            v.faults.append((
                f"the mass is forgotten: each node gets {text(f[0])} N, "
                "whatever its mass", "Weight is m g: multiply by "
                "n.value().mass."))
        return f"{text(f[0])} N on each node, whatever its mass"
    if factor(heavy, at_rest) is not None and any(map(any, f)):
        return "a force that differs from node to node"
    return "a force that differs from node to node and with the mass"


def drag(v, moving, at_rest, speeds, masses):
    """What the velocities add. moving: {v's factor: forces}"""
    part = {s: minus(f, at_rest) for s, f in moving.items()}
    power = max(dot(part[s], speeds) * s for s in part)
    if power > NEAR:
        v.faults.append((f"it gives power: {power:.3g} W to masses that move, "
                         "so it drives what it should brake",
                         "Drag points against the velocity: f = -c v."))
    odd = factor(part[-1], part[1])
    twice = factor(part[2], part[1])
    c = [-dot(f, s) / dot(s, s) for f, s in zip(nodes(part[1]),
                                                nodes(speeds))]
    along = distance(part[1], [-k * x for k, p in zip(c, nodes(speeds))
                               for x in p]) < NEAR
    words = "a force that depends on the velocity"
    if twice and abs(twice - 2) < NEAR and odd and abs(odd + 1) < NEAR:
        words += ", linear in it"
        if along and max(c) - min(c) < NEAR:
            words = f"linear drag -c v, c = {c[0]:.4g} kg/s"
        elif along and distance([k / m for k, m in zip(c, masses)],
                                [c[0] / masses[0]] * 4) < NEAR:
            words = (f"linear drag -c v, c = {c[0] / masses[0]:.4g} 1/s times "
                     "the mass")
    elif twice and twice > 0:
        words += f", in proportion to its power {math.log2(twice):.3g}"
    if odd and abs(odd - 1) < NEAR:
        v.faults.append(("it is the same for v and -v: one of them it drives",
                         "Drag changes its sign with the velocity: -c |v| v "
                         "has the power 2, -c v^2 in each coordinate not."))
    return words


def read(v, where, numbers):
    begin, base = numbers["before"][0], numbers["base"]
    for name, rows in numbers.items():
        if name != "length" and any(x != x or abs(x) > 1e100
                                    for row in rows for x in row):
            raise BadInput(f"{where}: returns NaN or infinity for four masses "
                           "and six springs")
    if any(row != base[0] for row in base[1:]):
        raise BadInput(f"{where}: keeps something from call to call: the same "
                       "node at the same time gets another force")
    if numbers["after"][0] != begin or any(
            row != numbers["data"][0] for row in numbers["data"]):
        v.faults.append(("it changes nodes or springs", "A force returns a "
                         "Point, and changes nothing."))
    x = [begin[k:k + 3] for k in range(0, len(begin), 6)]
    speeds = [c for k in range(3, len(begin), 6) for c in begin[k:k + 3]]
    masses = numbers["data"][0][:4]
    of = {tuple(s): row for s, *row in zip(
        numbers["scales"], numbers["moving"], numbers["soft"],
        numbers["moved"])}
    at_rest, soft, _ = of[0, 1]
    parts = []
    if biggest(minus(at_rest, soft)) > NEAR:
        parts.append(springs(v, minus(at_rest, soft), x, masses))
        if not v.faults:
            compressed(v, numbers["length"])
        v.data["length"] = [(k * .7 / 4, row) for k, row in enumerate(
            numbers["length"]) if row[0] == row[0]]
    if biggest(soft) > NEAR:
        parts.append(field(v, soft, of[0, 2][1], shifted(of), masses))
    if any(biggest(minus(of[s, 1][0], at_rest)) > NEAR for s in (1, 2, -1)):
        parts.append(drag(v, {s: of[s, 1][0] for s in (1, 2, -1)}, at_rest,
                          speeds, masses))
    if any(f != f for row in numbers["length"] for f in row):
        v.faults.append(("it returns NaN where a spring has length 0",
                         "Return no force if l = 0: there is no direction."))
    v.is_a = "it is " + (" and ".join(parts) or "no force: 0 on all nodes")
    facts(v, numbers, of, x, speeds)


def shifted(of):
    """The force without springs in another place: the springs' own part does
    not know the place."""
    at_rest, soft, moved = of[0, 1]
    return minus(moved, minus(at_rest, soft))


def facts(v, numbers, of, x, speeds):
    at_rest, _, moved = of[0, 1]
    late = biggest(minus(numbers["later"][0], numbers["base"][0]))
    v.facts.append(("time", "does not matter" if late == 0 else
                    f"between 0.7 s and 13 s it changes by {size(late)} N"))
    by_x = numbers["jacobian"]
    n = len(by_x)
    place = [k for k in range(n) if k % 6 < 3]
    skew = max(abs(by_x[j][b] - by_x[k][a]) for a, j in enumerate(place)
               for b, k in enumerate(place)) / max(1, *(
                   biggest(by_x[k]) for k in place))
    if any(biggest(by_x[k]) > NEAR for k in range(n) if k % 6 > 2):
        power = dot(numbers["base"][0], speeds)
        v.facts.append(("F = -dE/dx", "no: it depends on velocities. Its power "
                        f"here is {power:.3g} W"))
    else:
        v.facts.append(("F = -dE/dx", f"{yes(skew < 1e-6)}: dF_i/dx_j and "
                        f"dF_j/dx_i differ by {size(skew)} of the largest"))
    if skew > 1e-6 and not v.faults:
        v.faults.append((
            "it is not -dE/dx of any energy E: on the way around a loop it "
            "does work", "Where energy should stay, derive the force from an "
            "energy: F = -dE/dx."))
    far = max(abs(by_x[k][i]) for k in range(n) if k % 6 > 2
              for i in range(n // 2) if i // 3 != k // 6)
    if far > NEAR:
        v.notes.append("it depends on the velocities of other nodes, which a "
                       "step may have changed already")
    free = biggest(minus(moved, at_rest)) < NEAR
    v.facts.append(("place", "does not matter: moved as a whole the masses "
                    "get the same forces" if free else "matters"))
    lost = total(at_rest)
    turn = [sum(p[a] * f[b] - p[b] * f[a] for p, f in zip(x, nodes(at_rest)))
            for a, b in ((1, 2), (2, 0), (0, 1))]
    v.facts.append(("momentum", "kept: the forces at rest add up to 0"
                    if biggest(lost) < NEAR else
                    f"the forces at rest add up to {text(lost)} N"))
    v.facts.append(("angular momentum", "kept: so do their torques"
                    if biggest(turn) < NEAR else
                    f"the torques add up to {text(turn)} N m"))
    heavy = factor(of[0, 2][0], at_rest)
    v.facts.append(("mass", "does not matter" if distance(
        at_rest, of[0, 2][0]) < NEAR else "it is in proportion to the masses"
        if heavy and abs(heavy - 2) < NEAR else "matters"))
