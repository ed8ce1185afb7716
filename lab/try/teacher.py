"""The first lines of a report, and one sentence of advice."""

import math
import textwrap

import orders
from judge import Verdict

ADVICE = {
    "forward Euler": "Your kick uses the old positions: this is forward Euler; "
    "it gains energy at any step. Move the nodes first, then compute the "
    "forces.",
    "symplectic Euler": "Kick by dt/2 before and after the drift: that is "
    "Verlet, of order 2 for the same number of forces.",
    "symplectic Euler, velocities first": "Kick by dt/2 before and after the "
    "drift: that is Verlet, of order 2 for the same number of forces.",
    "Verlet": "Keep it for contact and tearing; for smooth motion and small "
    "errors try PEFRL, of order 4.",
    "Verlet, positions first": "Keep it for contact and tearing; for smooth "
    "motion and small errors try PEFRL, of order 4.",
    "a Taylor step, x + h v + h^2 a/2 and v + h a": "The positions are exact "
    "to order 2, the velocities are not: use the mean of the old and the new "
    "force for them, which is Verlet.",
    "it is position-based": "How stiff it is follows from dt and the number of "
    "iterations: XPBD adds the compliance 1/(K dt^2), so that K counts.",
    "it brakes nodes along the springs itself, beside the forces": "Let the "
    "force have the dashpots, as it has the springs: then each method has "
    "them.",
    "it makes substeps": "Let who calls the step choose dt: substeps hide what "
    "a step costs.",
    "RK4": "It loses energy in long runs: for a cloth without drag PEFRL has "
    "the same order for the same work and keeps the energy.",
    "Yoshida 4": "Its long step back costs accuracy and stability: PEFRL takes "
    "one force more and has a hundredth of the error.",
    "pefrl": "Hard to beat for smooth motion; with contact every method falls "
    "to order 2 or less, and Verlet is cheaper.",
    "srkn11b": "Hard to beat below 1e-8 m; for coarser errors use PEFRL or "
    "Verlet.",
}


def conclude(v: Verdict) -> None:
    """Say what the step is and what to do next."""
    if not v.is_a:
        if v.order is None:
            all_orders = [v.orders[name].order for name in orders.SMOOTH
                          if name in v.orders]
            o = [x for x in all_orders if x == x]
            v.is_a = ("it does not converge" if not o or min(o) < .3 else
                      f"it is of order {min(o):.1f} on some problems, and on "
                      "others it does not converge"
                      if len(o) < len(all_orders) else
                      f"its order is no whole number: {min(o):.2f}")
        elif v.order <= 0:
            v.is_a = ("it does not converge: with smaller steps the error "
                      "stays")
        else:
            v.is_a = f"it is of order {v.order}"
            if not v.faults and v.table:
                v.is_a += ", and none of the methods known here"
    elif v.order is not None:
        v.is_a += f", of order {v.order}"
    if v.differs:
        v.is_a += f"; it differs when {v.differs}"
    if v.faults:
        v.advice = v.faults[0][1]
    elif v.differs:
        v.advice = ("Do the same in every step: leave obstacles to the "
                    "constraint, and the choice of dt to who calls the step; "
                    "the numbers below mix two methods.")
    elif v.name in ADVICE:
        v.advice = ADVICE[v.name]
    elif v.limit == 0:
        v.advice = ("It gains energy at any step without drag: compute the "
                    "forces at the new positions.")
    elif v.energy[0] and not v.symplectic:
        v.advice = ("It is not symplectic, so its energy drifts: for long runs "
                    "use kicks and drifts, in a symmetric order.")
    elif v.order == 1:
        v.advice = ("A symmetric order of kicks and drifts gives order 2 for "
                    "the same work: begin and end with half of one.")
    elif v.limit and v.limit < math.inf and v.limit < v.evaluations:
        v.advice = (f"Its limit for each force is "
                    f"{v.limit / v.evaluations:.2f}, Verlet's is 2: where "
                    "stability decides the step, Verlet is cheaper.")
    else:
        v.advice = ("Compare its dot with the curves: it pays where it lies "
                    "below them.")


def first_lines(v: Verdict) -> list[str]:
    """Sentences: what it is, and each fault."""
    return [f"{v.step}: {v.is_a}.",
            *(f"{v.step}: {what}." for what, _ in v.faults)]


def words(v: Verdict) -> str:
    lines = [*first_lines(v), f"Next: {v.advice}", ""]
    wide = max((len(what) for what, _ in v.facts), default=0)
    for what, text in v.facts:
        lines += textwrap.wrap(
            f"{what:{wide}}  {text}", 80, subsequent_indent=" " * (wide + 2),
            break_on_hyphens=False)
    lines += ["Note: " + note + "." for note in v.notes]
    return "\n".join(lines)
