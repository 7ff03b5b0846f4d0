"""What the verdicts amount to: groups of studies, the status of each study, the worst findings, the waivers."""

import re
from dataclasses import dataclass, field, replace

from . import numbers

FEWEST_RUNGS = 4  # of a ladder that may bear an order verdict (verification.md §3)

# Status of a study -> (word on the page, sign beside it, style). The word always stands beside the colour.
STATUSES = {
    "pass": ("PASS", "✓"),
    "fail": ("FAIL", "✗"),
    "inconclusive": ("INCONCLUSIVE", "?"),
    "waived": ("WAIVED", "≈"),
    "lost": ("ENDED EARLY", "✗"),
    "lost-expected": ("ENDED EARLY", "†"),
    "none": ("no verdict", "–"),
}

GLOSSARY = [
    ("PASS", "The fitted order and the order of the finest pair both lie inside the expected band; or every run ended early, as the study expects."),
    ("FAIL", "The whole 95 % confidence interval of the fitted order lies outside the expected band; or a run ended early that should not, "
             "or did not end early as the study expects."),
    ("INCONCLUSIVE", "The ladder cannot decide: the interval straddles an edge of the band, the finest pair lies outside it though the fit lies inside, "
                     "the rungs are too few or too close, or there is a floor, round-off, a drift of the order or noise, which the reason names."),
    ("WAIVED", "A FAIL or INCONCLUSIVE that the study accepts, with the reason it states. Always listed."),
    ("ENDED EARLY", "A run met its survival criterion before the end time (a field not finite, a particle outside the domain, "
                    "kinetic energy above its bound, or particles too close together). † marks an end that the study expects."),
    ("no verdict", f"No order was demanded, the ladder has fewer than {FEWEST_RUNGS} rungs, or an error is zero to the last bit: errors are shown, "
                   "orders are not judged."),
]

NORMS = [
    ("L1", "Σ V |φ − φₑ| / Σ V, with V the particle volume, φ the computed and φₑ the exact field."),
    ("L2", "√( Σ V (φ − φₑ)² / Σ V ); the Euclidean length of the error for vectors."),
    ("L∞", "max |φ − φₑ|."),
    ("relative", "The norm of the error divided by the same norm of φₑ. L1 ≤ L2 ≤ L∞ holds for absolute norms only."),
    ("order", "log(e₁/e₂) / log(h₁/h₂) of a rung and the next coarser one; the fit is the least-squares slope of log e on "
              "log h, with the half-width of its 95 % confidence interval (Student's t)."),
    ("n, h, dx, N", "Particle spacings along the reference length; smoothing length; particle spacing; number of particles."),
    ("pair evaluations", "Particle pairs visited by all loops of a run: a count of work that does not depend on the machine."),
    ("work", "Pair evaluations plus pressure-matrix entries touched by the linear solver: what a projection does beside its pairs "
             "counts, too."),
    ("front", "The schemes that no other one beats at equal error; for the rest, by what factor they cost more "
              "(log-log interpolation, no extrapolation)."),
]

OTHER_WORDS = [
    ("CHANGED, UNCHANGED", "Whether anything differs from the baseline that the gate does not forgive: an error level, an order, a demand, a verdict, "
                           "a count of work, or something that is missing. Round-off, run time and what is new are forgiven."),
    ("margin", "Of a PASS: how far the fitted order and that of the finest pair are from the nearest edge of the expected band."),
    ("agrees, DISAGREES", "Whether our runs bear out what a publication prints; each claim says how it is judged."),
    ("caught", "Of a seeded fault, which is a small wrong edit of the source: some check of the gate failed, and so saw it."),
    ("clean, MODIFIED", "Whether the source that was built is exactly that of the revision, or differs from it."),
]

OPERATOR_WORDS = [
    ("h/dx fixed", "Both go to zero together: the smoothing error falls, and what disorder does to the sums stays or grows."),
    ("h fixed", "dx goes to zero alone: the error against the operator's own limit, so that the smoothing error takes no part."),
    ("h ~ sqrt(dx)", "The joint path: h goes to zero more slowly than dx."),
    ("order", "Always in dx, along every path. Theory may demand zero or a negative one: such an operator does not converge."),
    ("undetermined", "Particles whose neighbours do not determine the operator, over all seeds; they take no part in the norms."),
    ("seed spread", "Largest over smallest L2 of the seeds, minus 1."),
    ("properties", "What the operator claims besides an order (exactness, symmetry, sums that vanish), each held to its bound."),
]


def early_ends(study):
    """The rungs of a study that did not survive."""
    return [sample for sample in study["samples"] if not sample["survived"]]


def expects_early_end(study):
    return study["expected"]["fate"] == "ends_early"


def ended_as_expected(study):
    """Not so if it ended sooner, or otherwise, than the study expects, or if another rung survived: that is a FAIL."""
    return expects_early_end(study) and study["fit"]["verdict"] in ("PASS", "NONE")


def is_short(study):
    return len(study["samples"]) < FEWEST_RUNGS


def status(study):
    """The key in STATUSES that a study amounts to."""
    verdict = study["fit"]["verdict"]
    if verdict in ("FAIL", "INCONCLUSIVE") and study["fit"]["waiver"]:
        return "waived"
    if verdict == "NONE":
        if not early_ends(study):
            return "none"
        return "lost-expected" if expects_early_end(study) else "lost"
    return verdict.lower()


def expectation(study):
    """The demanded band in words: 1.5…2.5, ≥ 0.9, or nothing."""
    expected = study["expected"]
    return numbers.band(expected["low"], expected["high"])


def fitted_order(fit):
    """1.87 ± 0.12, or nothing where there is no fit."""
    if fit["order"] is None:
        return ""
    interval = fit["ci95"]
    text = numbers.for_page(numbers.order(fit["order"]))
    return text if interval is None else f"{text} ± {numbers.order(interval)}"


def rung_list(samples):
    return ", ".join(numbers.integer(sample["n"]) for sample in samples)


def fit_line(study):
    """`fit: order p ± CI (expected a…b, source)`, or why there is no order; the verdict is set apart by the page."""
    fit, expected = study["fit"], study["expected"]
    if fit["order"] is None:
        if early_ends(study):
            known = ", as expected" if ended_as_expected(study) else ""
            return f"fit: none; {len(early_ends(study))} of {len(study['samples'])} rungs ended early{known}"
        if is_short(study):
            verbs = ("shows", "bears") if len(study["samples"]) == 1 else ("show", "bear")
            return f"fit: none; {plural(len(study['samples']), 'rung')} {verbs[0]} errors, but {verbs[1]} no order verdict"
        return "fit: none"
    band = expectation(study)
    demand = ", ".join(filter(None, [band and f"expected {band}", band and expected["source"]])) or "nothing demanded"
    norm = {"l1": "L1", "l2": "", "linf": "L∞"}.get(fit["norm"], fit["norm"])
    return f"fit{' of ' + norm if norm else ''}: order {fitted_order(fit)} ({demand})"


def matrix_note(study):
    """The small line below the word in the verdict matrix."""
    parts = [fitted_order(study["fit"])]
    lost = early_ends(study)
    held = [sample for sample in study["samples"] if sample["survived"]]
    as_expected = lost and ended_as_expected(study)
    if lost:
        parts.append(f"{'†' if as_expected else ''}n = {rung_list(lost)} ended early")
    if held and expects_early_end(study) and not as_expected:
        parts.append(f"{f'n = {rung_list(held)} ' if lost else ''}survived, against expectation")
    elif not lost and is_short(study) and study["fit"]["verdict"] == "NONE":
        parts.append(plural(len(study["samples"]), "rung"))
    return "; ".join(filter(None, parts))


@dataclass
class Group:
    """All that concerns one case with its settings."""
    label: str
    case: str
    studies: list = field(default_factory=list)
    runs: list = field(default_factory=list)
    fronts: list = field(default_factory=list)
    claims: list = field(default_factory=list)

    @property
    def schemes(self):
        return unique(study["scheme"] for study in self.studies)

    @property
    def fields(self):
        return unique(study["field"] for study in self.studies)

    def of_scheme(self, scheme):
        return [study for study in self.studies if study["scheme"] == scheme]

    def of_field(self, name):
        return [study for study in self.studies if study["field"] == name]

    def cell(self, scheme, name):
        """Studies in one cell of the verdict matrix: one, or several that differ in their tier."""
        return [study for study in self.studies if study["scheme"] == scheme and study["field"] == name]

    def common_rung(self):
        """The finest n that every scheme of the group has run; None if they share none."""
        rungs = [{sample["n"] for study in self.of_scheme(scheme) for sample in study["samples"]} for scheme in self.schemes]
        shared = set.intersection(*rungs) if rungs else set()
        return max(shared) if shared else None

    def compared_runs(self):
        """One run a scheme: at the common rung, of the first seed."""
        n = self.common_rung()
        runs = {}
        for run in self.runs:
            if run["n"] == n and (run["scheme"] not in runs or (run["seed"] or 0) < (runs[run["scheme"]]["seed"] or 0)):
                runs[run["scheme"]] = run
        return [runs[scheme] for scheme in self.schemes if scheme in runs]

    def results(self):
        """The result files that contribute to this group."""
        return unique_objects(study["result"] for study in self.studies)


def unique(values):
    return list(dict.fromkeys(values))


def unique_objects(values):
    return list({id(value): value for value in values}.values())


NUMERAL = r"[0-9]+(?:\.[0-9]+)?"


def natural(text):
    """A key that sorts re=10, re=100, re=1000 as people do."""
    return [(1, float(part), "") if re.fullmatch(NUMERAL, part) else (0, 0.0, part)
            for part in re.split(f"({NUMERAL})", text) if part]


def in_groups(results):
    """The studies by group: cases in the order of the file, the groups of a case in natural order."""
    groups = {}
    for study in results["studies"]:
        groups.setdefault(study["group"], Group(study["group"], study["case"])).studies.append(study)
    for kind in ("runs", "fronts", "claims"):
        for entry in results[kind]:
            if entry["group"] in groups:
                getattr(groups[entry["group"]], kind).append(entry)
    cases = unique(group.case for group in groups.values())
    return sorted(groups.values(), key=lambda group: (cases.index(group.case), natural(group.label)))


def all_schemes(results):
    """Every scheme in the order in which the files name them, which is the order in which the user asked for them."""
    return unique([study["scheme"] for study in results["studies"]]
                  + [curve["scheme"] for front in results["fronts"] for curve in front["curves"]])


@dataclass
class Finding:
    """One line of the findings: how bad (0 is worst), what, where, why, and the anchor it links to."""
    severity: int
    status: str
    where: str
    title: str
    reasons: list
    anchor: str


def early_end_reasons(group, scheme):
    """Each early end of a scheme once, though every field of the study repeats it: where, when, by which criterion."""
    reasons = [f"n = {numbers.integer(run['n'])}"
               + (f", seed {run['seed']}" if is_reseeded(group, scheme) and run["seed"] is not None else "")
               + f": {run['diagnosis'] or 'no diagnosis given'}"
               for run in group.runs if run["scheme"] == scheme and not run["survived"]]
    if not reasons:
        reasons = unique(f"n = {numbers.integer(sample['n'])}: {sample['diagnosis'] or 'no diagnosis given'}"
                         for study in group.of_scheme(scheme) for sample in early_ends(study))
    return reasons


def is_reseeded(group, scheme):
    return len({run["seed"] for run in group.runs if run["scheme"] == scheme}) > 1


def early_end_finding(group, scheme):
    """The early ends that are no finding as a verdict."""
    studies = [study for study in group.of_scheme(scheme) if early_ends(study) and not verdict_finding("", study)]
    if not studies:
        return []
    expected = all(map(expects_early_end, studies))
    severity, kind, title = (4, "lost-expected", "ended early, as expected") if expected else (1, "lost", "ended early")
    return [Finding(severity, kind, f"{group.label}, {scheme}", title, early_end_reasons(group, scheme), studies[0]["anchor"])]


def conservation_findings(group):
    """Runs that lost what their scheme claims to conserve."""
    return [Finding(0, "fail", f"{group.label}, {run['scheme']}", f"lost what it claims to conserve: {run['budget']['lost']}", [f"n = {numbers.integer(run['n'])}"],
                    group.anchor)
            for run in group.runs if run["survived"] and (run.get("budget") or {}).get("lost")]


def goal_findings(group):
    """Goals of our own that a run misses; claims of the literature that ours does not bear out are no fault of a build."""
    return [Finding(0, "fail", f"{group.label}, goal {claim['id']}", f"missed: {claim['ours']}", [claim["text"]], group.anchor)
            for claim in group.claims if claim.get("binding") and not claim["agrees"]]


def verdict_finding(place, study, reasons=None):
    """The finding that a verdict is, if it is one; `reasons` for it are those of the fit if there are no better ones."""
    fit = study["fit"]
    kind = status(study)
    reasons = reasons or [fit["reason"] or "no reason given"]
    if kind in ("fail", "inconclusive"):
        return [Finding(0 if kind == "fail" else 2, kind, place, fit_line(study), reasons, study["anchor"])]
    if kind == "waived":
        return [Finding(3, kind, place, f"{fit['verdict']}, waived", [*reasons, "Waiver: " + fit["waiver"]], study["anchor"])]
    if expects_early_end(study) and not early_ends(study):
        return [Finding(2, kind, place, "survived, though the study expects it to end early", reasons, study["anchor"])]
    return []


def verdict_findings(group):
    """The verdicts that are findings; the fields of a scheme of which the same is to be said as one."""
    together = {}
    for study in group.studies:
        is_judged_by_its_end = early_ends(study) and not expects_early_end(study) and study["fit"]["order"] is None
        for found in verdict_finding("", study, early_end_reasons(group, study["scheme"]) if is_judged_by_its_end else None):
            alike = study["scheme"], study.get("tier"), found.status, found.title, *found.reasons
            together.setdefault(alike, (found, []))[1].append(study["field"])
    return [replace(found, where=f"{group.label}, {scheme}, {', '.join(fields)}") for (scheme, *_), (found, fields) in together.items()]


def findings(groups):
    """All findings on schemes, in the order of the page."""
    found = []
    for group in groups:
        for scheme in group.schemes:
            found += early_end_finding(group, scheme)
        found += conservation_findings(group) + goal_findings(group) + verdict_findings(group)
    return found


def waivers(groups):
    """Every study with a waiver, needed or not."""
    return [study for group in groups for study in group.studies if study["fit"]["waiver"]]


def counts(studies):
    """Number of studies by status."""
    tally = dict.fromkeys(STATUSES, 0)
    for study in studies:
        tally[status(study)] += 1
    return tally


def verdict_counts(studies):
    """The number of verdicts in words, and how many of each; order verdicts where each is one, as that on an early end is not."""
    tally = counts(studies)
    judged = [study for study in studies if study["fit"]["verdict"] != "NONE"]
    article, noun = ("an", "order verdict") if all(study["fit"]["order"] is not None for study in judged) else ("a", "verdict")
    words = [f"{tally[key]} {STATUSES[key][0]}" for key in ("pass", "fail", "inconclusive", "waived") if tally[key]]
    text = f"{plural(len(judged), noun)}" + (f" ({', '.join(words)})" if words else "")
    return text + (f", {tally['none']} without {article} {noun}" if tally["none"] else "")


def summary(groups):
    """What became of the schemes, in one sentence; nothing without schemes."""
    if not groups:
        return ""
    studies = [study for group in groups for study in group.studies]
    cases, schemes = unique(group.case for group in groups), unique(study["scheme"] for study in studies)
    text = f"{plural(len(schemes), 'scheme')} on {plural(len(cases), 'case')} in {plural(len(groups), 'setting')}: "
    text += verdict_counts(studies)
    ladders = ([study for study in group.of_scheme(scheme) if early_ends(study)] for group in groups for scheme in group.schemes)
    ends = [ladder for ladder in ladders if ladder]
    if ends:
        is_waived = lambda study: status(study) == "waived"
        known = sum(all(ended_as_expected(study) or is_waived(study) for study in ladder) for ladder in ends)
        how = "as expected or waived" if any(is_waived(study) for ladder in ends for study in ladder) else "as expected"
        text += f"; {plural(len(ends), 'ladder')} ended early, " + (how if known == len(ends) else f"{known} of them {how}" if known else "not as expected")
    return text + "."


def plural(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"
