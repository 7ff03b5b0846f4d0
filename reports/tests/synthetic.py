"""Result files made up for the tests: the tree of FORMAT.md written by h5py, and trees that resemble real studies.

    PYTHONPATH=reports/tests:reports python3 -m synthetic demo.h5               # the file that the page was designed on
    PYTHONPATH=reports/tests:reports python3 -m synthetic variants.h5 variants  # many schemes with histories and pictures
"""

import math
import sys

import h5py
import numpy

TEXT = h5py.string_dtype("utf-8")


# ------------------------------------------------------------------------------------------------------ writing

def is_flat(value):
    return value is None or isinstance(value, (bool, int, float, str))


def is_table(items):
    return all(isinstance(item, dict) and item.keys() == items[0].keys() and all(map(is_flat, item.values())) for item in items)


def write_column(group, name, values):
    """One column of a table; returns whether it is boolean."""
    known = [value for value in values if value is not None]
    if any(isinstance(value, str) for value in known):
        group.create_dataset(name, data=["" if value is None else value for value in values], dtype=TEXT)
    elif known and all(isinstance(value, bool) for value in known):
        group.create_dataset(name, data=numpy.array(values, "u1"))
        return True
    elif known and len(known) == len(values) and all(isinstance(value, int) for value in known):
        group.create_dataset(name, data=numpy.array(values, "i8"))
    else:
        group.create_dataset(name, data=numpy.array([math.nan if value is None else value for value in values], "f8"))
    return False


def write_list(parent, name, items):
    if items and isinstance(items[0], dict):
        group = parent.create_group(name)
        if is_table(items):
            group.attrs["_list"] = "table"
            flags = [key for key in items[0] if write_column(group, key, [item[key] for item in items])]
            if flags:
                group.attrs.create("_booleans", flags, dtype=TEXT)
        else:
            group.attrs["_list"] = "items"
            for index, item in enumerate(items):
                write_object(group.create_group(f"{index:04d}"), item)
    elif not items:
        parent.create_group(name).attrs["_list"] = "empty"
    else:
        write_column(parent, name, items)


def write_object(group, tree):
    flags = []
    for name, value in tree.items():
        if value is None:
            continue
        if isinstance(value, dict):
            write_object(group.create_group(name), value)
        elif isinstance(value, list):
            write_list(group, name, value)
        elif isinstance(value, bool):
            group.attrs.create(name, int(value), dtype="u1")
            flags.append(name)
        elif isinstance(value, int):
            group.attrs.create(name, value, dtype="i8")
        elif isinstance(value, float):
            group.attrs.create(name, value, dtype="f8")
        else:
            group.attrs.create(name, value, dtype=TEXT)
    if flags:
        group.attrs.create("_booleans", flags, dtype=TEXT)


def write(path, tree):
    with h5py.File(path, "w") as stream:
        write_object(stream, tree)
    return path


# ------------------------------------------------------------------------------------------------------- content

PROVENANCE = {"version": "0.1.0", "revision": "4f1c2d7e9ab03c55d1e8f6a0b7c9d2e3f4a5b6c7", "tree_clean": True,
              "compiler": "GNU 12.2.0", "flags": "-O3 -march=native -fno-math-errno -fno-trapping-math", "build_type": "Release",
              "cpu": "Intel Xeon Platinum 8488C", "threads": 2,
              "libraries": {"Eigen": "3.4.0", "GSL": "2.7.1", "HDF5": "1.10.8", "OpenMP": "4.5"},
              "started": "2025-11-22T15:40:12Z", "seconds": 41.7}
TAYLOR_GREEN = {"name": "taylor_green", "summary": "Decaying array of vortices in a doubly periodic square (Taylor and Green).",
                "equations": "∂u/∂t + (u·∇)u = −∇p/ρ + ν ∇²u,  ∇·u = 0\n"
                             "u = −U exp(−8π²t/Re) cos 2πx sin 2πy,  v = U exp(−8π²t/Re) sin 2πx cos 2πy,  "
                             "p = −¼ ρU² exp(−16π²t/Re) (cos 4πx + cos 4πy)",
                "source": "Taylor & Green 1937, Proc. R. Soc. A 158; as used in Xu 2009, PhD thesis, §4.1", "dimension": 2,
                "reference_length": 1.0, "domain": "[0, 1] × [0, 1] m, periodic in both directions, 0 ≤ t ≤ 1 s",
                "parameters": [{"name": "re", "value": 100.0, "unit": "1", "summary": "Reynolds number U L / ν"},
                               {"name": "U", "value": 1.0, "unit": "m/s", "summary": "largest speed at t = 0"},
                               {"name": "rho", "value": 1.0, "unit": "kg/m3", "summary": "density"}]}
ABC_FLOW = {"name": "abc_flow", "summary": "Decaying Arnold–Beltrami–Childress flow, an exact solution in three dimensions.",
            "equations": "∂u/∂t + (u·∇)u = −∇p/ρ + ν ∇²u,  ∇·u = 0,  ∇×u = k u", "dimension": 3, "reference_length": 1.0,
            "source": "Dombre et al. 1986, J. Fluid Mech. 167", "domain": "[0, 1]³ m, periodic",
            "parameters": [{"name": "re", "value": 50.0, "unit": "1", "summary": "Reynolds number"}]}
STAGES = {"wcsph": ["neighbours", "equation_of_state", "continuity", "pressure_gradient", "viscosity_morris", "predictor_corrector"],
          "isph_df": ["neighbours", "viscosity_morris", "pressure_poisson", "projection", "advance"],
          "isph_dfs": ["neighbours", "viscosity_morris", "pressure_poisson", "projection", "shifting", "taylor_correction", "advance"]}
WEIGHTS = {"neighbours": 2.0, "pressure_poisson": 9.0, "viscosity_morris": 2.5, "pressure_gradient": 2.4, "shifting": 1.6}
FIELDS = [("x", 16, "advance"), ("u", 16, "advance"), ("p", 8, "pressure"), ("rho", 8, "continuity"), ("neighbour_list", 84, "neighbours")]
SPEED = {"wcsph": 2.1e6, "isph_df": 4.2e5, "isph_dfs": 3.5e5}
DIAGNOSIS = ("minimum spacing 0.12 dx below 0.2 dx at step {step}, t = {time:.3f} s, particle {particle} at ({x:.3f}, 0.500): "
             "the particles line up on the stagnation streamlines")


def wobble(*parts):
    """A small number that is the same in every run, for curves that look measured."""
    return math.sin(sum((i + 1) * 7.3 * hash_of(part) for i, part in enumerate(parts)))


def hash_of(part):
    return sum(ord(letter) * (i + 1) for i, letter in enumerate(str(part))) % 97 / 9.7


def sample(scheme, n, error, dimension=2, steps_per_n=6.0, diagnosis="", solver=True):
    """One rung. A diagnosis makes it a run that ended early."""
    particles, steps = n ** dimension, int(steps_per_n * n)
    if diagnosis:
        steps //= 3
    seconds = particles * steps / SPEED.get(scheme, 1e6) * (1 + 0.05 * wobble(scheme, n))
    survived = not diagnosis
    null = lambda value: value if survived else None
    return {"n": n, "h": 1.3 / n, "dx": 1.0 / n, "particles": particles, "dt": 1 / (6.0 * n), "steps": steps,
            "l1": null(0.8 * error), "l2": null(error), "linf": null(2.7 * error), "l1_abs": null(0.4 * error),
            "l2_abs": null(0.5 * error), "linf_abs": null(1.2 * error), "relative": True, "l2_spread": None, "seeds": 1,
            "seconds": seconds, "seconds_spread": 0.03, "repeats": 3, "cpu_seconds": 1.98 * seconds,
            "pair_evaluations": particles * steps * 21 * (3 if solver else 4),
            "solver_iterations": steps * (8 + n // 10) if solver else 0,
            "matrix_entries": particles * steps * 21 if solver else 0, "particle_steps": particles * steps,
            "survived": survived, "diagnosis": diagnosis}


def pairwise(samples, norm):
    orders = [math.nan]
    for coarse, fine in zip(samples, samples[1:]):
        known = coarse[norm] and fine[norm]
        orders.append(math.log(coarse[norm] / fine[norm]) / math.log(coarse["h"] / fine["h"]) if known else math.nan)
    return orders


def slope(samples):
    """Least-squares order and its 95 % half-width for up to six rungs."""
    points = [(math.log(s["h"]), math.log(s["l2"])) for s in samples if s["l2"]]
    x0, y0 = (sum(values) / len(points) for values in zip(*points))
    spread = sum((x - x0) ** 2 for x, _ in points)
    order = sum((x - x0) * (y - y0) for x, y in points) / spread
    rest = sum((y - y0 - order * (x - x0)) ** 2 for x, y in points)
    student = {2: 4.30, 3: 3.18, 4: 2.78}.get(len(points) - 2, math.inf)
    return order, student * math.sqrt(rest / max(1, len(points) - 2) / spread)


def study(case, group, scheme, field, samples, low=None, high=None, verdict=None, reason="", waiver=None, fate=None, settings=None):
    fit = {"norm": "l2", "verdict": verdict or "NONE", "reason": reason,
           **{f"order_{norm}": pairwise(samples, norm) for norm in ("l1", "l2", "linf")}}
    if verdict in ("PASS", "FAIL", "INCONCLUSIVE"):
        fit["order"], fit["ci95"] = slope(samples)
    if waiver:
        fit["waiver"] = waiver
    expected = {"low": low, "high": high, "text": "First order: the Laplacian on a shifted arrangement is consistent to O(h).",
                "source": "Xu 2009, §4.3.3" , "fate": fate}
    return {"case": case, "group": group, "scheme": scheme, "field": field, "tier": "quick", "settings": settings or {},
            "expected": expected, "fit": fit, "samples": samples}


def run(case, group, scheme, sample):
    names = STAGES.get(scheme, ["neighbours", "advance"])
    weight = sum(WEIGHTS.get(name, 0.5) for name in names)
    return {"case": case, "group": group, "scheme": scheme, "n": sample["n"], "seed": 1, "survived": sample["survived"],
            "diagnosis": sample["diagnosis"], "end_time": 1.0 if sample["survived"] else 0.231, "setup_seconds": 0.012,
            "bytes_per_particle": 132, "neighbour_bytes_per_particle": 1204, "pair_bytes_per_particle": 317 if scheme != "wcsph" else 0,
            "stages": [{"name": name, "seconds": sample["seconds"] * WEIGHTS.get(name, 0.5) / weight,
                        "pair_evaluations": sample["particle_steps"] * 21 if WEIGHTS.get(name) else 0} for name in names],
            "fields": [{"name": name, "bytes_per_particle": size, "asked_by": asker} for name, size, asker in FIELDS],
            "settings": {"kernel": "quintic_spline", "h_over_dx": 1.3, "eta": 0.0, "gradients": "normalised",
                         "scheme": scheme, "n": sample["n"], "c0": 10.0 if scheme == "wcsph" else None, "shifting": scheme == "isph_dfs",
                         "ppe": {"tolerance": 1e-8, "solver": "cg"} if scheme != "wcsph" else {}},
            "energy_error": -0.4 * sample["l2"] if sample["l2"] else None, "minimum_spacing": 0.71 if sample["survived"] else 0.12}


def front(group, field, cost, studies):
    curves = [{"scheme": study["scheme"], "n": [s["n"] for s in study["samples"] if s["survived"]],
               "error": [s["l2"] for s in study["samples"] if s["survived"]],
               "cost": [float(s[cost]) for s in study["samples"] if s["survived"]]} for study in studies]
    curves = [curve for curve in curves if curve["n"]]
    best = min(curves, key=lambda curve: curve["cost"][-1] * curve["error"][-1])
    rows = [{"scheme": curve["scheme"], "on_front": curve is best,
             "slower_by": None if curve is best else curve["cost"][-1] * curve["error"][-1] / best["cost"][-1] / best["error"][-1],
             "at_error": None if curve is best else curve["error"][-1], "than": "" if curve is best else best["scheme"]} for curve in curves]
    return {"group": group, "field": field, "norm": "l2", "cost": cost, "curves": curves, "rows": rows}


class Builder:
    """Grows a result tree group by group."""

    def __init__(self):
        self.tree = {"format": "sphvv-results", "format_version": 1,
                     "command": "sphvv verify taylor_green --scheme wcsph,isph_df,isph_dfs --set re=100 --n 20,40,80,160 --out results.h5",
                     "provenance": dict(PROVENANCE), "cases": [TAYLOR_GREEN, ABC_FLOW], "studies": [], "runs": [], "fronts": []}

    def add(self, case, group, scheme, rungs, order, level, dimension=2, lost=(), fields=None, settings=None):
        """One scheme of a group; `fields` maps a field to the keywords of its study."""
        solver = scheme != "wcsph"
        for field, keywords in (fields or {"velocity": {}, "pressure": {}}).items():
            factor, drop = (3.0, 0.15) if field == "pressure" else (1.0, 0.0)
            samples = []
            for n in rungs:
                error = factor * level * (20 / n) ** (order - drop) * (1 + 0.03 * wobble(scheme, field, n))
                diagnosis = DIAGNOSIS.format(step=3 * n, time=14.0 / n, particle=7 * n, x=0.25 + 1 / n) if n in lost else ""
                samples.append(sample(scheme, n, error, dimension, diagnosis=diagnosis, solver=solver))
            self.tree["studies"].append(study(case, group, scheme, field, samples, settings=settings, **keywords))
        self.tree["runs"] += [run(case, group, scheme, s) for s in samples]

    def rank(self, group):
        studies = [study for study in self.tree["studies"] if study["group"] == group]
        for field in dict.fromkeys(study["field"] for study in studies):
            for cost in ("seconds", "pair_evaluations"):
                self.tree["fronts"].append(front(group, field, cost, [s for s in studies if s["field"] == field]))


def realistic():
    """A tree like that of the first real studies, with every verdict in it."""
    builder = Builder()
    ladder, group, case = [20, 40, 80, 160], "taylor_green re=100", "taylor_green"
    settings = {"re": 100.0, "t": 1.0}
    builder.add(case, group, "wcsph", ladder, 1.62, 0.031, settings=settings, fields={
        "velocity": dict(low=1.0, high=2.2, verdict="PASS", reason="slope and finest pair inside the band"),
        "pressure": dict(low=1.7, high=2.2, verdict="FAIL", reason="the whole interval lies below 1.7: the sound speed of 10 U limits the pressure")})
    lost = dict(fate="ends_early", reason="nothing fitted: three rungs ended early")
    builder.add(case, group, "isph_df", ladder, 1.1, 0.045, lost=(40, 80, 160), settings=settings,
                fields={"velocity": lost, "pressure": lost})
    builder.add(case, group, "isph_dfs", ladder, 1.08, 0.024, settings=settings, fields={
        "velocity": dict(low=0.9, verdict="PASS", reason="slope and finest pair inside the band"),
        "pressure": dict(low=0.9, high=1.3, verdict="INCONCLUSIVE", reason="the interval reaches below 0.9; residuals show a floor from the PPE tolerance")})
    builder.rank(group)
    for re in (10, 1000):
        group = f"taylor_green re={re}"
        for scheme, level in (("isph_df", 0.05), ("isph_dfs", 0.03)):
            builder.add(case, group, scheme, [40, 80], 1.0, level * re ** 0.2, lost=(40, 80) if re == 1000 and scheme == "isph_df" else (),
                        settings={"re": float(re)})
        builder.rank(group)
    case = group = "abc_flow"
    rungs = [10, 14, 20, 28, 40]
    builder.add(case, group, "wcsph", rungs, 1.7, 0.06, dimension=3, fields={
        "velocity": dict(low=1.0, high=2.2, verdict="PASS", reason="slope and finest pair inside the band"),
        "pressure": dict(low=1.8, high=2.2, verdict="FAIL", reason="the whole interval lies below 1.8",
                         waiver="Known: the Tait pressure carries acoustic noise; see issue 3. Remove when the density diffusion is in.")})
    builder.add(case, group, "isph_dfs", rungs, 1.05, 0.04, dimension=3, fields={
        "velocity": dict(low=0.9, verdict="PASS", reason="slope and finest pair inside the band"),
        "pressure": dict(low=0.8, verdict="PASS", reason="slope and finest pair inside the band")})
    builder.rank(group)
    return builder.tree


def small():
    """One group of it, with every verdict but a waiver, for tests that need a report but not all of it."""
    tree = realistic()
    for kind in ("studies", "runs", "fronts"):
        tree[kind] = [entry for entry in tree[kind] if entry["group"] == "taylor_green re=100"]
    return tree


# ------------------------------------------------------------------------------------- histories, pictures, budgets

VARIANTS = ["wcsph", "wcsph:continuity=sigma_1:pressure_force=sigma_1",
            "wcsph:continuity=renormalised:pressure_force=renormalised_coherent", "isph_df", "isph_dfs",
            "isph_dfs:shift_correction=none", "isph_dfs:shift_correction=second", "isph_lee", "isph_mls"]
EARLY, BLOWN_UP, BARE = "isph_df", "isph_lee", "isph_mls"  # ends early; ends early as not finite; of an older file
DECAY = 8 * math.pi ** 2 / 100  # of the speed of Taylor-Green at Re = 100


def history(scheme, level, end_time):
    """Forty marks and the last step; errors that a blown-up run cannot give are null."""
    rows = []
    for mark in range(1, round(40 * end_time) + 1):
        time = mark / 40 + 0.001
        exact = math.exp(-DECAY * time)
        growth = math.exp(40 * (time - end_time)) if scheme == BLOWN_UP else 0.0
        rows.append({"time": time, "l2_velocity": level * math.sqrt(time) * (1 + 0.1 * wobble(scheme, mark)) + 50 * growth,
                     "l2_pressure": 3 * level * (1 + 0.2 * wobble(scheme, mark)), "maximum_speed": exact * (1 + level * time + 8 * growth),
                     "maximum_speed_exact": exact, "energy_error": 2 * level * time})
    if scheme == BLOWN_UP:
        rows.append({"time": end_time + 0.01, "l2_velocity": None, "l2_pressure": None, "maximum_speed": None,
                     "maximum_speed_exact": math.exp(-DECAY * end_time), "energy_error": None})
    return rows


def picture(scheme, across, time):
    """A lattice carried along by the vortices, or for other schemes than the one that ends early shaken; periodic."""
    generator = numpy.random.default_rng(hash_of(scheme).__trunc__())
    places = (numpy.arange(across) + 0.5) / across - 0.5
    x, y = (axis.ravel() for axis in numpy.meshgrid(places, places))
    velocity = lambda x, y: (-numpy.cos(2 * math.pi * x) * numpy.sin(2 * math.pi * y), numpy.sin(2 * math.pi * x) * numpy.cos(2 * math.pi * y))
    if scheme == EARLY:
        for _ in range(100):
            u, v = velocity(x, y)
            x, y = x + u * time / 100, y + v * time / 100
    else:
        x, y = (axis + generator.uniform(-0.25, 0.25, axis.size) / across for axis in (x, y))
    x, y = (numpy.mod(axis + 0.5, 1.0) - 0.5 for axis in (x, y))
    size, noise = math.exp(-DECAY * time), 0.4 if scheme == "wcsph" else 0.02
    pressure = 7.0 - 250 * size ** 2 * (numpy.cos(4 * math.pi * x) + numpy.cos(4 * math.pi * y) + noise * generator.normal(size=x.size))
    speed = size * numpy.hypot(*velocity(x, y))
    if scheme == BLOWN_UP:
        x[:3], speed[3:8], pressure[3:8] = math.nan, math.nan, math.inf
    values = {"x": x, "y": y, "speed": speed, "pressure": pressure}
    return {"time": time, **{name: [float(value) for value in column] for name, column in values.items()}, "box": [-0.5, 0.5, -0.5, 0.5]}


def budget(scheme, level, time):
    elastic = {"elastic_energy_start": 0.3, "elastic_energy_end": 0.8, "internal_torque": 3.6e-4} if scheme.startswith("wcsph") else {}
    end = 250 * math.exp(-2 * DECAY * time) * (1 + 2 * level * time)
    return {"momentum_drift": 2.5e-4 * level, "kinetic_energy_start": 250.0, "kinetic_energy_end": end, "energy_drift": end / 250 - 1,
            "claims": "momentum, angular momentum, energy" if scheme.startswith("wcsph") else "momentum, angular momentum" if scheme == "isph_lee"
            else "nothing", "lost": "momentum, angular momentum" if scheme == "wcsph" else "momentum" if scheme == "isph_lee" else "", **elastic}


def variants(across=40):
    """One group of nine schemes and variants with histories, pictures of across² particles, budgets and thirty claims."""
    builder, group = Builder(), "taylor_green re=100"
    for index, scheme in enumerate(VARIANTS):
        lost = (40,) if scheme in (EARLY, BLOWN_UP) else ()
        builder.add("taylor_green", group, scheme, [20, 28, 40], 1.0 + 0.1 * index, 0.02 + 0.004 * index, lost=lost)
    builder.rank(group)
    tree = builder.tree
    for entry in tree["fronts"]:
        if entry["cost"] == "pair_evaluations":
            entry["cost"] = "work"
    for run in tree["runs"]:
        level = 0.01 + 0.004 * VARIANTS.index(run["scheme"])
        if run["scheme"] == BARE or run["n"] != 40:
            continue
        run.update(history=history(run["scheme"], level, run["end_time"]), picture=picture(run["scheme"], across, run["end_time"]),
                   budget=budget(run["scheme"], level, run["end_time"]))
    tree["claims"] = [{"group": group, "id": f"XU-TG {number}", "text": "ISPH_DF is unstable where ISPH_DFS with the same parameters carries on",
                       "published": "1.10 (1213 s / 1103 s); check <= 1.15" if number % 2 else "stated", "source": "Xu 2009 §4.1, table of CPU times",
                       "ours": "at 40² DF ends at t = 0.25 (spacing 0.21 dx), DFS survives (0.53 dx)", "agrees": number % 5 != 0}
                      for number in range(1, 31)]
    return tree


# ------------------------------------------------------------------------------------------------ operator workbench

OPERATORS = [("gradient_plain", "gradient"), ("gradient_renormalised", "gradient"), ("laplacian_morris", "laplacian"),
             ("shifting_vector", "nothing")]
# Dimension, arrangement, path, and the order of each operator that has one.
OPERATOR_LADDERS = [(2, "square", "h/dx fixed", (2.0, 2.0, 2.0)), (2, "jittered 10 %", "h/dx fixed", (-1.0, 1.6, -1.0)),
                    (2, "jittered 20 %", "h ~ sqrt(dx)", (0.5, 1.0, 0.5)), (3, "jittered 10 %", "h/dx fixed", (-1.0, 1.6, -1.0))]


def operator_study(operator, kind, ladder, order):
    dimension, arrangement, path, _ = ladder
    samples = []
    for n in (40, 56, 80, 112, 160):
        error = 0.1 * (40 / n) ** order * (1 + 0.02 * wobble(operator, arrangement, n))
        samples.append({"n": n, "h": 1.3 / n, "dx": 1.0 / n, "particles": n ** dimension, "l1": 0.8 * error, "l2": error,
                        "linf": 3 * error, "l1_abs": 1.6 * error, "l2_abs": 2 * error, "linf_abs": 5 * error,
                        "l2_spread": None if arrangement == "square" else 0.02, "seeds": 1 if arrangement == "square" else 5,
                        "undetermined": 0.0, "pair_evaluations": 21.0 * n ** dimension})
    fit = {"norm": "l2", "verdict": "PASS", "reason": "inside the band",
           **{f"order_{norm}": pairwise(samples, norm) for norm in ("l1", "l2", "linf")}}
    fit["order"], fit["ci95"] = slope(samples)
    return {"operator": operator, "approximates": kind, "dimension": dimension, "arrangement": arrangement, "path": path,
            "kernel": "quintic_spline", "tier": "nightly", "samples": samples, "fit": fit,
            "expected": {"low": order - 0.25, "high": order + 0.25, "source": "Quinlan, Basa & Lastiwka 2006"}}


def operator_property(operator, name, value, passes=True):
    return {"operator": operator, "dimension": 2, "property": name, "arrangement": "jittered 20 %, free sides", "value": value,
            "bound": 1e-12, "at_least": False, "passes": passes}


def operator_front(cost):
    curves = [{"operator": name, "error": [0.1, 0.2], "cost": [scale * 1e5, scale * 4e5]}
              for name, scale in (("gradient_plain", 1.0), ("gradient_renormalised", 0.8))]
    rows = [{"operator": "gradient_plain", "on_front": False, "slower_by": 1.25, "at_error": 0.1, "than": "gradient_renormalised"},
            {"operator": "gradient_renormalised", "on_front": True, "slower_by": None, "at_error": None, "than": ""}]
    return {"approximates": "gradient", "cost": cost, "curves": curves, "rows": rows}


def kernel_check(kernel, dimension, check, value, expected, passes=True):
    return {"kernel": kernel, "dimension": dimension, "check": check, "value": value, "expected": expected, "tolerance": 1e-12,
            "passes": passes, "why": "definition"}


def workbench():
    """A file of `sphvv operators`, and the seeded faults, with every kind of failure in it."""
    tree = {**realistic(), "command": "sphvv operators --tier nightly --out operators.h5",
            **{name: [] for name in ("cases", "studies", "runs", "fronts", "claims")}}
    studies = [operator_study(name, kind, ladder, order) for ladder in OPERATOR_LADDERS
               for (name, kind), order in zip(OPERATORS, ladder[3])]
    studies[0]["fit"].update(verdict="FAIL", reason="the whole interval is outside: a lattice sum is off")
    studies[4]["fit"].update(verdict="INCONCLUSIVE", reason="the residuals bend: a floor")
    kernels = [kernel_check(kernel, dimension, check, value, value) for kernel in ("cubic_spline", "wendland_c2")
               for check, value in (("unit integral", 1.0), ("second moment", 0.5), ("transform", 0.0)) for dimension in (1, 2, 3)]
    kernels += [kernel_check("cubic_spline", 0, "smoothness", 1.1, 2.0, passes=False), kernel_check("wendland_c2", 0, "smoothness", 2.0, 2.0)]
    figure = {"text": "error of the Laplacian at a free edge", "source": "Xu 2009 §3.5", "value": 57.0, "ours": "57 %"}
    fault = {"file": "solver/operators/laplacian_morris.cpp", "seconds": 84.2}
    tree.update(
        operators=[{"name": name, "summary": f"the {name}", "formula": "sum_j V_j A_j gradW_ij", "source": "Xu 2009 §2.1.2",
                    "approximates": kind, "order_source": "moments"} for name, kind in OPERATORS],
        operator_studies=studies,
        operator_properties=[operator_property("gradient_plain", "exact for constants", 3e-16),
                             operator_property("gradient_renormalised", "exact for linears", 2e-3, passes=False),
                             operator_property("shifting_vector", "zero on a lattice", 1e-17)],
        operator_costs=[{"operator": name, "dimension": 2, "nanoseconds_per_pair": 0.8 + index, "spread": 0.1, "pairs": 72944.0}
                        for index, (name, _) in enumerate(OPERATORS)],
        operator_fronts=[operator_front("nanoseconds"), operator_front("pair_evaluations")],
        kernel_checks=kernels,
        known_errors=[kernel_check("wendland_c2", 3, "known error: Wendland C2 in 3-D, Xu", 0.6666667, 1.0),
                      kernel_check("quintic_spline", 3, "known error: quintic spline, 359", 1.0, 1.0, passes=False)],
        published_figures=[{"id": "XU-LAP row 0", "published": "57 %", "agrees": True, "waiver": "", **figure},
                           {"id": "XU-LAP surface", "published": "40 %", "agrees": False, "waiver": "another h/dx", **figure},
                           {"id": "XU-LAP row 1", "published": "3.2 %", "agrees": False, "waiver": "", **figure},
                           {"id": "XU-LAP row 2", "published": "57.1 %", "agrees": True, "waiver": "left over", **figure}],
        consistency_sums=[{"jitter": jitter, "h_over_dx": ratio, "neighbours": 12.6 * ratio ** 2, "worst_zeroth": (0.02 + jitter) / ratio,
                           "worst_first": (0.01 + jitter) / ratio} for jitter in (0.0, 0.2) for ratio in (1.2, 2.0, 3.0)],
        seeded_faults=[{"name": "morris_factor", "summary": "a factor 2 is lost", "caught": True, "caught_by": "operators", **fault},
                       {"name": "morris_eta", "summary": "eta is not squared", "caught": False, "caught_by": "", **fault}])
    return tree


def pressure_matrix(**more):
    return {"study": "stability/conditioning", "name": "periodic, 16 x 16", "laplacian": "morris", "boundary": "periodic", "columns": 16,
            "rows": 16, "jitter": 0.0, "seed": 1, "coincident": False, "mean": 0.0, "unknowns": 256, "surface_share": 0.0, "least": 38.0,
            "greatest": 570.0, "condition": 15.0, "theory": 15.1, "condition_jacobi": 15.0, "theory_jacobi": 15.1, "diagonal_ratio": 1.0,
            "negative_share": 0.0, "least_of_field": None, "iterations_jacobi": 20, "bound_jacobi": 40, "iterations_two_level": 19,
            "tolerance": 1, "converged": True, "residual": 1e-9, **more}


def conditioning():
    """Matrices on each of the three axes, and checks of which one fails and one has no value."""
    check = {"study": "stability/conditioning", "subject": "periodic, 16 x 16", "name": "condition number", "value": 15.0, "low": 14.9,
             "high": 15.2, "tolerance": 0.0, "why": "the symbol", "verdict": "PASS", "passes": True, "reason": "the symbol"}
    return {"conditioning_rows": [
                pressure_matrix(), pressure_matrix(name="periodic, 32 x 32", columns=32, unknowns=1024, condition=60.0, theory=60.0),
                pressure_matrix(name="periodic, 20 x 20, Schwaiger", columns=20, laplacian="schwaiger", jitter=0.5, condition=30.0, theory=None,
                                condition_jacobi=None, theory_jacobi=None, bound_jacobi=None, least_of_field=36.0),
                pressure_matrix(name="surface, 24 x 4", boundary="surface", surface_share=0.25)],
            "conditioning_checks": [check, {**check, "name": "asymmetry", "value": 0.5, "low": 0.0, "high": 1e-12, "verdict": "FAIL", "passes": False,
                                            "reason": "outside the band"},
                                    {**check, "name": "measurement", "value": None, "verdict": "FAIL", "passes": False, "reason": "thrown: a bug"}]}


def stability():
    """What sphvv stability writes: a limit that agrees, one that does not, one that there is not, and a map with a disagreement."""
    limit = {"study": "stability/acoustic", "kernel": "wendland_c2", "h_over_dx": 1.3, "limit": "acoustic", "published": 0.002,
             "reason": "within 5 %", "theory_by": "linearised step", "low": 0.95, "high": 1.05, "runs": 16, "seconds": 0.3}
    return {"stability_limits": [{"scheme": "wcsph", "theory": 4.5, "measured": 4.51, "verdict": "PASS", "passes": True, **limit},
                                 {"scheme": "isph_df", "theory": 2.0, "measured": 1.0, "verdict": "FAIL", "passes": False, **limit},
                                 {"scheme": "isph_dfs", "theory": None, "measured": None, "verdict": "PASS", "passes": True, **limit}],
            "stability_maps": [{"study": "stability/tensile_map", "scheme": "wcsph", "x_name": "h/dx", "x": [1.0, 1.5, 2.0], "y_name": "p/(rho c0^2)",
                                "y": [-0.01, 0.01], "theory": [1.1, 1.1, 1.1, 1.0, 1.0, 1.1], "measured": [None, 1.1, 1.1, 1.0, 1.1, 1.1],
                                "grows": [1.0, 1.0, 1.0, 0.0, 1.0, 1.0], "criterion": "w'' p < 0",
                                "by_criterion": [1.0, 1.0, 0.0, 0.0, 0.0, 1.0], "unstable": 1.0017, "disagreements": 1, "undecided": 0,
                                "verdict": "FAIL", "passes": False, "reason": "1 of 6 points", "seconds": 1.0}],
            "extreme_rows": [{"name": "a single particle", "scheme": "wcsph", "must": "goes straight on", "why": "no neighbour", "fate": "bounded",
                              "bound": 1e-12, "survived": True, "diagnosis": "", "error": 2.0, "steps": 200, "seconds": 0.1, "verdict": "FAIL",
                              "passes": False, "waiver": "", "reason": "the error is above its bound"}],
            **conditioning()}


def comparison(change="verdict", **more):
    """What `sphvv compare BASELINE FILE --json` writes, with one difference that fails the gate and one that does not."""
    row = {"subject": "isph_dfs", "where": "taylor_green re=100, velocity, n = 80", "what": "verdict", "baseline": "PASS", "current": "FAIL", "factor": 1.0}
    return {"format": "sphvv-comparison", "format_version": 1,
            "baseline": {"file": "taylor_green.json", "revision": "0123456789abcdef", "started": ""},
            "current": {"file": "results.h5", "revision": PROVENANCE["revision"], "started": PROVENANCE["started"]},
            "compared": 210, "bitwise_equal": 208, "fails": True,
            "differences": [{"change": change, **row}, {"change": "run time", **row, "what": "seconds", "baseline": "1.0", "current": "1.2"}], **more}


def nights(count=3, faulty=(1,)):
    """Lines of a history: one ladder that keeps its error, and one whose error is ten times as large and its verdict FAIL in the `faulty` nights."""
    ladder = {"group": "taylor_green re=100", "scheme": "isph_dfs", "ci95": 0.1, "waived": False, "n": 80, "pair_evaluations": 2e8,
              "matrix_entries": 3e8, "seconds": 4.0}
    lines = []
    for night in range(count):
        broken = night in faulty
        rows = [{**ladder, "field": "velocity", "order": 0.2 if broken else 1.08, "verdict": "FAIL" if broken else "PASS", "l2": 0.11 if broken else 0.011},
                {**ladder, "field": "pressure", "order": 0.95, "verdict": "PASS", "l2": 0.04},
                {"group": "stability_limits", "scheme": "wcsph", "field": "stability/acoustic", "verdict": "PASS", "l2": 4.5}]
        lines.append({"date": f"2025-11-2{night}T03:00:00+00:00", "tier": "nightly", "revision": f"{night}" * 40, "seconds": 3600.0 + night, "rows": rows})
    return lines


def many(settings=9):
    """More ladders than a first screen can show one by one: variants of three schemes in so many settings of two cases."""
    builder = Builder()
    for case in ("taylor_green", "abc_flow"):
        for number in range(settings):
            for scheme in ("wcsph", "isph_dfs", "isph_dfs:shift_correction=none"):
                verdict = "FAIL" if (case, number, scheme) == ("abc_flow", 1, "wcsph") else "PASS"
                builder.add(case, f"{case}/setting_{number}", scheme, [20, 28, 40, 56], 1.5, 0.03,
                            fields={"velocity": dict(low=1.0 + 0.01 * number, high=2.5, verdict=verdict, reason="as made up")})
    return builder.tree


if __name__ == "__main__":
    write(sys.argv[1], {"variants": variants}[sys.argv[2]]() if len(sys.argv) > 2 else realistic())
