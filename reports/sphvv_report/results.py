"""Result files (reports/FORMAT.md): read an HDF5 or JSON file into a plain tree of dicts and lists, check it, merge several.

Every failure is a ResultError whose text is one sentence naming the file and what is wrong with it.
"""

import json
import math
import multiprocessing
import os
import re
import resource

import h5py
import numpy

FORMAT = "sphvv-results"
FORMAT_VERSION = 1
DEEPEST = 32  # levels of groups; a file that nests deeper is damaged or made to hang its readers

# The members a report stands on. A trailing "?" marks one that may be missing (JSON null is "no member"), a "!" one that may not be null, as an
# array may not that must be there.
# A list holds the schema of its entries; "number" and "text" entries of a table may be null.
PARAMETER = {"name": "text", "value?": "any", "unit?": "text", "summary?": "text"}
VARIANT = {"scheme": "text", "name": "text"}
CASE = {"name": "text", "group?": "text", "variants?": [VARIANT], "summary?": "text", "equations?": "text", "source?": "text", "reference?": "text", "dimension?": "number",
        "reference_length?": "number", "domain?": "text", "parameters?": [PARAMETER]}
SAMPLE = {"n!": "number", "h!": "number", "dx": "number", "particles": "number", "dt": "number", "steps": "number",
          "l1": "number", "l2": "number", "linf": "number", "l1_abs": "number", "l2_abs": "number", "linf_abs": "number",
          "relative": "flag", "l2_spread": "number", "seeds": "number", "seconds": "number", "seconds_spread": "number",
          "repeats": "number", "cpu_seconds": "number", "pair_evaluations": "number", "solver_iterations": "number",
          "matrix_entries": "number", "particle_steps": "number", "survived!": "flag", "diagnosis": "text"}
EXPECTED = {"low?": "number", "high?": "number", "text?": "text", "source?": "text", "fate?": "text"}
FIT = {"norm?": "text", "order?": "number", "ci95?": "number", "verdict": "text", "reason?": "text", "waiver?": "text",
       "order_l1?": "numbers", "order_l2?": "numbers", "order_linf?": "numbers"}
STUDY = {"case": "text", "group": "text", "scheme": "text", "field": "text", "tier?": "text", "axis?": "text", "settings?": "object",
         "expected?": EXPECTED, "fit": FIT, "samples": [SAMPLE]}
STAGE = {"name": "text", "seconds": "number", "pair_evaluations": "number"}
RUN_FIELD = {"name": "text", "bytes_per_particle": "number", "asked_by": "text"}
BUDGET = {name + "?": "number" for name in ("momentum_drift", "kinetic_energy_start", "kinetic_energy_end", "elastic_energy_start",
                                            "elastic_energy_end", "energy_drift", "internal_torque")}
BUDGET.update({"claims?": "text", "lost?": "text"})
MARK = {"time": "number", "l2_velocity": "number", "l2_pressure": "number", "maximum_speed": "number",
        "maximum_speed_exact": "number", "energy_error": "number"}
PICTURE = {"time?": "number", "box?": "numbers", **{name + "?": "numbers" for name in ("x", "y", "speed", "pressure")}}
PROFILE = {"field": "text", "coordinate": "numbers", "ours": "numbers", "exact": "numbers"}
RUN = {"case": "text", "group": "text", "scheme": "text", "n!": "number", "seed?": "number", "survived!": "flag",
       "diagnosis?": "text", "end_time?": "number", "setup_seconds?": "number", "bytes_per_particle?": "number",
       "neighbour_bytes_per_particle?": "number", "pair_bytes_per_particle?": "number",
       "stages": [STAGE], "fields": [RUN_FIELD], "settings?": "object", "energy_error?": "number",
       "minimum_spacing?": "number", "maximum_speed_error?": "number", "budget?": BUDGET, "history?": [MARK],
       "picture?": PICTURE, "profiles?": [PROFILE]}
CURVE = {"scheme": "text", "n": "numbers", "error": "numbers", "cost": "numbers"}
FRONT_ROW = {"scheme": "text", "on_front": "flag", "slower_by": "number", "at_error": "number", "than": "text"}
FRONT = {"group": "text", "field": "text", "norm": "text", "cost": "text", "curves": [CURVE], "rows": [FRONT_ROW]}
CLAIM = {"group": "text", "id": "text", "text": "text", "published": "text", "source": "text", "ours": "text", "agrees!": "flag", "binding?": "flag"}
OPERATOR = {"name": "text", "summary": "text", "formula": "text", "source": "text", "approximates": "text", "order_source": "text"}
OPERATOR_SAMPLE = {"n!": "number", "h!": "number", "dx!": "number", "particles": "number", "l1": "number", "l2": "number",
                   "linf": "number", "l1_abs": "number", "l2_abs": "number", "linf_abs": "number", "l2_spread": "number",
                   "seeds": "number", "undetermined": "number", "pair_evaluations": "number"}
OPERATOR_STUDY = {"operator": "text", "approximates": "text", "dimension!": "number", "arrangement": "text", "path": "text",
                  "kernel": "text", "tier": "text", "expected?": EXPECTED, "fit": FIT, "samples": [OPERATOR_SAMPLE]}
OPERATOR_PROPERTY = {"operator": "text", "dimension!": "number", "property": "text", "arrangement": "text", "value": "number",
                     "bound!": "number", "at_least!": "flag", "passes!": "flag"}
OPERATOR_COST = {"operator": "text", "dimension": "number", "nanoseconds_per_pair": "number", "spread": "number",
                 "pairs": "number"}
OPERATOR_CURVE = {"operator": "text", "error": "numbers", "cost": "numbers"}
OPERATOR_FRONT_ROW = {"operator": "text", "on_front": "flag", "slower_by": "number", "at_error": "number", "than": "text"}
OPERATOR_FRONT = {"approximates": "text", "cost": "text", "curves": [OPERATOR_CURVE], "rows": [OPERATOR_FRONT_ROW]}
KERNEL_CHECK = {"kernel": "text", "dimension!": "number", "check": "text", "value": "number", "expected": "number",
                "tolerance": "number", "passes!": "flag", "why": "text"}
PUBLISHED_FIGURE = {"id": "text", "text": "text", "published": "text", "source": "text", "ours": "text", "value": "number",
                    "reference?": "number", "tolerance?": "number", "is_bound?": "flag", "agrees!": "flag", "waiver": "text"}
CONSISTENCY_SUM = {"jitter": "number", "h_over_dx": "number", "neighbours": "number", "worst_zeroth": "number",
                   "worst_first": "number"}
SEEDED_FAULT = {"name": "text", "file": "text", "summary": "text", "caught!": "flag", "caught_by": "text", "seconds": "number"}
STABILITY_LIMIT = {"study": "text", "scheme": "text", "kernel": "text", "h_over_dx": "number", "limit": "text", "published": "number",
                   "theory": "number", "theory_by?": "text", "measured": "number", "low?": "number", "high?": "number", "verdict": "text",
                   "passes!": "flag", "reason": "text", "runs": "number", "seconds": "number"}
STABILITY_MAP = {"study": "text", "scheme": "text", "x_name": "text", "x": "numbers", "y_name": "text", "y": "numbers", "theory": "numbers",
                 "measured": "numbers", "grows": "numbers", "criterion?": "text", "by_criterion?": "numbers", "unstable": "number", "disagreements!": "number", "undecided": "number",
                 "verdict": "text", "passes!": "flag", "reason": "text", "seconds?": "number"}
EXTREME_ROW = {"name": "text", "scheme": "text", "must": "text", "why": "text", "fate": "text", "bound": "number", "survived!": "flag",
               "diagnosis": "text", "error": "number", "steps": "number", "seconds": "number", "verdict": "text", "passes!": "flag",
               "waiver": "text", "reason": "text"}
CONDITIONING_ROW = {"study": "text", "name": "text", "laplacian": "text", "boundary": "text", "columns": "number", "rows": "number",
                    "jitter!": "number", "seed": "number", "coincident": "flag", "mean": "number", "unknowns!": "number",
                    "surface_share!": "number", "least": "number", "greatest": "number", "condition": "number", "theory": "number",
                    "condition_jacobi": "number", "theory_jacobi": "number", "diagonal_ratio": "number", "negative_share": "number",
                    "least_of_field": "number", "iterations_jacobi": "number", "bound_jacobi": "number", "iterations_two_level": "number",
                    "tolerance": "number", "converged": "flag", "residual": "number"}
CONDITIONING_CHECK = {"study": "text", "subject": "text", "name": "text", "value": "number", "low": "number", "high": "number",
                      "tolerance": "number", "why": "text", "verdict": "text", "passes!": "flag", "reason": "text"}
STABILITY = {"stability_limits?": [STABILITY_LIMIT], "stability_maps?": [STABILITY_MAP], "extreme_rows?": [EXTREME_ROW],
             "conditioning_rows?": [CONDITIONING_ROW], "conditioning_checks?": [CONDITIONING_CHECK]}
WORKBENCH = {"operators?": [OPERATOR], "operator_studies?": [OPERATOR_STUDY], "operator_properties?": [OPERATOR_PROPERTY],
             "operator_costs?": [OPERATOR_COST], "operator_fronts?": [OPERATOR_FRONT], "kernel_checks?": [KERNEL_CHECK],
             "known_errors?": [KERNEL_CHECK], "published_figures?": [PUBLISHED_FIGURE],
             "consistency_sums?": [CONSISTENCY_SUM], "seeded_faults?": [SEEDED_FAULT]}
PROVENANCE = {"version": "text", "revision": "text", "tree_clean": "flag", "compiler?": "text", "flags?": "text",
              "build_type?": "text", "cpu?": "text", "threads?": "number", "libraries?": "object", "started?": "text",
              "seconds?": "number", "interrupted?": "flag"}
RESULT = {"format": "text", "format_version": "number", "command": "text", "provenance": PROVENANCE,
          "cases": [CASE], "studies": [STUDY], "runs": [RUN], "fronts": [FRONT], "claims?": [CLAIM],
          **WORKBENCH, **STABILITY}
# A file that holds none of these says nothing that a report could show.
EVIDENCE = ("studies", "operator_studies", "operator_properties", "kernel_checks", "known_errors", "published_figures",
            "seeded_faults", "stability_limits", "stability_maps", "extreme_rows", "conditioning_rows", "conditioning_checks")
VERDICTS = ("PASS", "FAIL", "INCONCLUSIVE", "NONE")


class ResultError(Exception):
    """A result file that cannot be used; the text is one sentence for the user."""


# ---------------------------------------------------------------------------------------------------- reading

CONTROL_CHARACTERS = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff]")


def clean_text(value):
    """Text that XML can carry: bytes decoded, lone surrogates and control characters removed."""
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    return CONTROL_CHARACTERS.sub("", str(value).encode("utf-8", "replace").decode("utf-8"))


def scalar(value):
    """A plain Python value; NaN is null."""
    if isinstance(value, numpy.generic):
        value = value.item()
    if isinstance(value, (str, bytes)):
        return clean_text(value)
    if isinstance(value, float) and math.isnan(value):
        return None
    return value


def entries(dataset):
    """The entries of a one-dimensional dataset as plain values."""
    return [scalar(value) for value in numpy.atleast_1d(dataset[()])]


def read_table(group, flags, depth):
    """A list of flat objects, stored as one dataset a column."""
    columns = {clean_text(name): entries(dataset) for name, dataset in members(group, depth)}
    for name in flags & columns.keys():
        columns[name] = [bool(value) for value in columns[name]]
    if len({len(column) for column in columns.values()}) > 1:
        raise ValueError(f"the columns of {group.name} differ in length")
    return [dict(zip(columns, row)) for row in zip(*columns.values())]


def members(group, depth):
    """Name and object of each member. Links out of the file are refused: a result file is one file."""
    if depth > DEEPEST:
        raise ValueError(f"it nests deeper than {DEEPEST} levels")
    for name in sorted(group):
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{group.name} holds a link instead of a value: {name}")
        yield name, group[name]


def read_group(group, depth=0):
    """One group as the tree it stands for: an object or a list."""
    attributes = dict(group.attrs)
    flags = {clean_text(name) for name in numpy.atleast_1d(attributes.pop("_booleans", []))}
    kind = attributes.pop("_list", None)
    kind = clean_text(kind) if kind is not None else None
    if kind == "empty":
        return []
    if kind == "items":
        return [read_group(child, depth + 1) for _, child in members(group, depth)]
    if kind == "table":
        return read_table(group, flags, depth)
    if kind is not None:
        raise ValueError(f"{group.name} is a list of unknown kind '{kind}'")
    tree = {}
    for name, value in attributes.items():
        value = scalar(value)
        tree[clean_text(name)] = bool(value) if name in flags else value
    for name, child in members(group, depth):
        tree[clean_text(name)] = read_group(child, depth + 1) if isinstance(child, h5py.Group) else entries(child)
    return {name: value for name, value in tree.items() if value is not None}


def refuse_unreadable(path):
    """Says in words why a file cannot be one of ours, before the HDF5 library says it in its own."""
    if not os.path.exists(path):
        raise ResultError(f"{path}: no such file")
    if not os.path.isfile(path):
        raise ResultError(f"{path}: not a file, but a result file (.h5) is needed")
    if not os.access(path, os.R_OK):
        raise ResultError(f"{path}: no permission to read it")
    if os.path.getsize(path) == 0:
        raise ResultError(f"{path}: the file is empty, not a result file")
    if not h5py.is_hdf5(path) and not is_json(path):
        raise ResultError(f"{path}: not an HDF5 file and not JSON, so not a result file of sphvv")


def is_json(path):
    """Whether the file begins as a JSON object does."""
    with open(path, "rb") as stream:
        return stream.read(64).lstrip()[:1] == b"{"


def refuse_foreign(path, attributes):
    """Refuses another format and a newer version before looking at anything else."""
    if clean_text(scalar(attributes.get("format", ""))) != FORMAT:
        raise ResultError(f"{path}: not a result file of sphvv (its member 'format' is not \"{FORMAT}\")")
    version = scalar(attributes.get("format_version", 0))
    if not isinstance(version, (int, float)) or isinstance(version, bool) or version < 1:
        raise ResultError(f"{path}: its format_version is not a version that ever was (this report reads 1 to {FORMAT_VERSION})")
    if version > FORMAT_VERSION:
        raise ResultError(f"{path}: written by a newer sphvv (format version {version}, this report reads up to "
                          f"{FORMAT_VERSION}); use the report of that version")


def plain(value):
    """A JSON value with the texts cleaned as those of an HDF5 file are."""
    if isinstance(value, dict):
        return {clean_text(name): plain(entry) for name, entry in value.items()}
    return [plain(entry) for entry in value] if isinstance(value, list) else scalar(value)


def read_json(path):
    """The JSON twin of a result file."""
    with open(path, encoding="utf-8") as stream:
        tree = plain(json.load(stream))
    refuse_foreign(path, tree)
    return tree


def read_tree(path):
    """The whole file as a tree. Raises ResultError."""
    try:
        if is_json(path):
            return read_json(path)
        with h5py.File(path, "r") as stream:
            refuse_foreign(path, stream.attrs)
            return read_group(stream)
    except ResultError:
        raise
    except Exception as error:  # h5py raises OSError, RuntimeError, KeyError, ValueError, ... on damage
        detail = clean_text(str(error)).strip("'\"").splitlines()
        what = "truncated" if "truncated" in str(error) else "damaged"
        raise ResultError(f"{path}: the file is {what} ({detail[0] if detail else type(error).__name__})") from None


def send_tree(path, pipe):
    """Reads the file in a process of its own and sends (tree, None) or (None, message)."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        pipe.send((read_tree(path), None))
    except ResultError as error:
        pipe.send((None, str(error)))


def read_tree_apart(path):
    """The whole file as a tree, read in a child process: on a damaged file the HDF5 library may crash the process that reads."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=send_tree, args=(path, sender), daemon=True)
    child.start()
    sender.close()
    try:
        tree, message = receiver.recv()
    except EOFError:
        raise ResultError(f"{path}: the file is damaged (the HDF5 library could not survive reading it)") from None
    finally:
        receiver.close()
        child.join()
    if message is not None:
        raise ResultError(message)
    return tree


# --------------------------------------------------------------------------------------------------- checking

def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_kind(value, kind):
    """Whether a non-null value is of the kind the schema asks for."""
    return {"any": True, "text": isinstance(value, str), "number": is_number(value), "flag": isinstance(value, bool),
            "object": isinstance(value, dict),
            "numbers": isinstance(value, list) and all(v is None or is_number(v) for v in value)}[kind]


KIND_NAMES = {"text": "a text", "number": "a number", "flag": "a boolean", "object": "an object", "numbers": "an array of numbers"}


def check_entry(value, kind, path):
    """Checks one entry of a table, where null is allowed; returns it with null in one form only."""
    if kind == "number" and value == "":
        return None  # a column that is null throughout has lost its kind in the file
    if kind == "text" and value is None:
        return ""
    if value is not None and not is_kind(value, kind):
        raise ValueError(f"{path} is not {KIND_NAMES[kind]}")
    return value


def check_object(tree, schema, path):
    """Checks an object against its schema; `path` is where it stands, for the message.

    Members that may be missing are filled in (None for a number, "" for a text, {} or []), so that nobody downstream has to ask.
    """
    if not isinstance(tree, dict):
        raise ValueError(f"{path or 'the root'} is not an object")
    for key, kind in schema.items():
        name = key.rstrip("?!")
        where = f"{path}.{name}" if path else name
        optional = key.endswith("?")
        if name not in tree and not optional:
            raise ValueError(f"{where} is missing")
        if tree.get(name) is None:
            tree[name] = [] if isinstance(kind, list) else {} if isinstance(kind, dict) or kind == "object" else None
        if isinstance(kind, list):
            check_list(tree[name], kind[0], where)
        elif isinstance(kind, dict):
            check_object(tree[name], kind, where)
        else:
            tree[name] = check_entry(tree[name], kind, where)
            if tree[name] is None and (key.endswith("!") or kind == "numbers" and not optional):
                raise ValueError(f"{where} is null")


def check_list(trees, schema, path):
    if not isinstance(trees, list):
        raise ValueError(f"{path} is not a list")
    for index, tree in enumerate(trees):
        check_object(tree, schema, f"{path}[{index}]")


def check_study(study, path):
    """What the schema cannot say: known verdicts, as many pairwise orders as rungs."""
    fit = study["fit"]
    if fit["verdict"] not in VERDICTS:
        raise ValueError(f"{path}.fit.verdict is '{fit['verdict']}', not one of {', '.join(VERDICTS)}")
    for name in ("order_l1", "order_l2", "order_linf"):
        if fit[name] and len(fit[name]) != len(study["samples"]):
            raise ValueError(f"{path}.fit.{name} has {len(fit[name])} entries for {len(study['samples'])} rungs")


def check_curve(curve, path):
    if len({len(column) for column in curve.values() if isinstance(column, list)}) > 1:
        raise ValueError(f"{path}: its arrays differ in length")


def check_picture(picture, path):
    """A picture has all of its members or, where there is none, no member at all."""
    columns = [picture[name] for name in ("x", "y", "speed", "pressure")]
    if all(value is None for value in picture.values()):
        return
    if None in columns or len(set(map(len, columns))) > 1:
        raise ValueError(f"{path}: x, y, speed and pressure are not arrays of one length")
    if len(picture["box"] or []) != 4 or None in picture["box"]:
        raise ValueError(f"{path}.box is not low x, high x, low y, high y")


def check_profile(profile, path):
    if len({len(profile[name]) for name in ("coordinate", "ours", "exact")}) > 1:
        raise ValueError(f"{path}: coordinate, ours and exact differ in length")


def check_map(chart, path):
    points = len(chart["x"]) * len(chart["y"])
    for name in ("theory", "measured", "grows"):
        if len(chart[name]) != points or not points:
            raise ValueError(f"{path}.{name} is not one value for each of x and y")
    if any(None in chart[name] for name in ("x", "y", "grows")) or chart["unstable"] is None:
        raise ValueError(f"{path}: x, y, grows and unstable must be finite")
    if chart["criterion"] and (len(chart["by_criterion"] or []) != points or None in chart["by_criterion"]):
        raise ValueError(f"{path}.by_criterion is not one finite value for each of x and y")


def check_result(tree):
    """Checks the tree of a file; ValueError names the first member that is missing or wrong."""
    check_object(tree, RESULT, "")
    for kind in KEYS:
        for index, study in enumerate(tree[kind]):
            check_study(study, f"{kind}[{index}]")
    for kind in ("fronts", "operator_fronts"):
        for index, front in enumerate(tree[kind]):
            for number, curve in enumerate(front["curves"]):
                check_curve(curve, f"{kind}[{index}].curves[{number}]")
    for index, run in enumerate(tree["runs"]):
        check_picture(run["picture"], f"runs[{index}].picture")
        for number, profile in enumerate(run["profiles"]):
            check_profile(profile, f"runs[{index}].profiles[{number}]")
    for index, chart in enumerate(tree["stability_maps"]):
        check_map(chart, f"stability_maps[{index}]")
    for index, row in enumerate(tree["extreme_rows"]):
        if row["passes"] and row["fate"] == "bounded" and None in (row["error"], row["bound"]):
            raise ValueError(f"extreme_rows[{index}] passes its bound and has no error or no bound")
    if not any(tree[kind] for kind in EVIDENCE):
        raise ValueError("it holds no study, no check and no seeded fault")


def name_variants(tree):
    """Calls variants of schemes by the short names that the file has for them, group by group."""
    names = {(case["group"], variant["scheme"]): variant["name"] for case in tree["cases"] for variant in case["variants"]}
    for study in tree["studies"]:
        study["base_scheme"] = study["scheme"].split(":")[0]
    for kind in ("studies", "runs", "fronts"):
        for entry in tree[kind]:
            for named in [entry] if kind != "fronts" else entry["curves"] + entry["rows"]:
                for member in {"scheme", "than"} & named.keys():
                    named[member] = names.get((entry["group"], named[member]), named[member])


def read_result(path):
    """Reads and checks one result file. Raises ResultError. The tree gains `file`, the file's own name."""
    refuse_unreadable(path)
    tree = read_tree_apart(path)
    try:
        check_result(tree)
    except ValueError as error:
        raise ResultError(f"{path}: not a complete result file: {error}") from None
    name_variants(tree)
    tree["file"] = clean_text(os.path.basename(path))
    return tree


# ---------------------------------------------------------------------------------------------------- merging

# What identifies a study, and the part of it that a message names.
KEYS = {"studies": ("case", "group", "scheme", "field", "tier"),
        "operator_studies": ("operator", "dimension", "arrangement", "path", "kernel", "tier")}
REPEATABLE = {"operator_properties", "kernel_checks", "known_errors", "published_figures", "consistency_sums", "seeded_faults",
              *(name.rstrip("?") for name in STABILITY)}
# These explain what others refer to by a key, which this makes of an entry: any file's entry will do.
NAMED = {"cases": lambda case: (case["name"], case["group"]), "operators": lambda operator: operator["name"]}


def refuse_twice(results, kind):
    """Refuses a study that stands in two files."""
    holder = {}
    for result in results:
        for study in result[kind]:
            key = tuple(study[name] for name in KEYS[kind])
            if key in holder:
                words = [str(part) for part in (key[1:] if kind == "studies" else key) if part]
                raise ResultError(f"{result['file']}: the study {', '.join(words)} is already in {holder[key]}; "
                                  "give each study once")
            holder[key] = result["file"]


def distinct(entries):
    """The entries without those that another file repeats in every value but the time that it took."""
    kept = []
    for entry in entries:
        if not any(all(entry[key] == other.get(key) for key in entry if key not in ("result", "seconds")) for other in kept):
            kept.append(entry)
    return kept


def merge(results):
    """Several result files as one: {"files": results} and every list of RESULT, "cases" by name and group, "operators" by name.

    A study that stands in two files is refused: which of the two a reader sees must not depend on the order of the
    arguments. Each entry remembers its file. Fronts stay apart, since a front only ranks what one file holds. A check that
    several files hold with the same outcome counts once.
    """
    merged = {"files": results}
    for kind in KEYS:
        refuse_twice(results, kind)
    for kind in (name.rstrip("?") for name, schema in RESULT.items() if isinstance(schema, list)):
        if kind in NAMED:
            merged[kind] = {}
            for entry in (entry for result in results for entry in result[kind]):
                merged[kind].setdefault(NAMED[kind](entry), entry)
        else:
            entries = [dict(entry, result=result) for result in results for entry in result[kind]]
            merged[kind] = distinct(entries) if kind in REPEATABLE else entries
    return merged
