"""What each scheme keeps of what an isolated fluid keeps: momentum, energy, the balance of torques."""

from . import numbers
from .tables import Column, Table

MEANING = ("Momentum drift: |P(t) − P(0)| over total mass times largest expected speed. Kinetic energy: Σ m u²/2 at the start and at t. "
           "Energy drift: change of the energy (kinetic and, of a compressible scheme, elastic) over the kinetic energy at the start; "
           "exact viscosity is part of it. Against exact decay: kinetic energy at t over the exact one at t, minus 1, so that what "
           "exact viscosity takes is out of it. Internal torque: |½ Σ r × f| of the forces between particles over the kinetic energy "
           "at the start, at t. Closest pair: smallest distance of two particles during the run. – where a scheme has no such thing. "
           "Claims: what the scheme's sums over pairs conserve to round-off (energy: without viscosity, in the limit of a small step); "
           "kept: momentum and torque to 1e-10, lost where the run was further off, not measured where the scheme tells no torque; "
           "no verdict on energy, of which viscosity takes some.")


def kept(budget):
    """What became of each claim, in words; None where the file tells no claims."""
    if not budget.get("claims"):
        return None
    lost = (budget.get("lost") or "").split(", ")

    def verdict(claim):
        if claim in lost:
            return "lost"
        if claim == "energy":
            return "viscous"
        measured = {"momentum": "momentum_drift", "angular momentum": "internal_torque"}.get(claim)
        return "kept" if budget.get(measured) is not None else "not measured"

    return ", ".join(f"{claim}: {verdict(claim)}" for claim in budget["claims"].split(", ") if claim != "nothing")


def table(names, group, dimension):
    """One row a scheme, at the finest common rung; None where no run has a budget."""
    runs = [run for run in group.compared_runs() if any(value not in (None, "") for value in run["budget"].values())]
    if not runs:
        return None
    rows = [{"scheme": run["scheme"], "n": run["n"], "seed": run["seed"], "end_time": run["end_time"], **run["budget"], "kept": kept(run["budget"]),
             "energy_error": run["energy_error"], "minimum_spacing": run["minimum_spacing"], "survived": run["survived"],
             "how": "to the end" if run["survived"] else "ended early"} for run in runs]
    joule = {2: "J/m", 3: "J"}.get(dimension, "")
    columns = [Column("scheme", "scheme"), Column("n", "n", "integer"), Column("seed", "seed", shown=False),
               Column("end_time", "t", "significant", "s", "$t$"),
               Column("momentum_drift", "momentum drift", "scientific"),
               Column("kinetic_energy_start", "kinetic energy, start", "significant", joule),
               Column("kinetic_energy_end", "at t", "significant", joule),
               Column("elastic_energy_start", "elastic energy, start", shown=False), Column("elastic_energy_end", "at t", shown=False),
               Column("energy_drift", "energy drift", "scientific"), Column("energy_error", "against exact decay", "scientific"),
               Column("internal_torque", "internal torque", "scientific"), Column("minimum_spacing", "closest pair", "significant", "dx"),
               Column("claims", "claims"), Column("kept", "kept"), Column("how", "run"), Column("survived", "survived", "flag", shown=False)]
    return Table(names.unique(group.label, "budget"), f"what each scheme keeps, n = {numbers.integer(group.common_rung())}",
                 columns, rows, [MEANING], context=group.label)
