"""The command line: `python3 -m sphvv_report FILE… --out DIR [--json FILE] [--quiet]`."""

import argparse
import json
import os
import sys

from .results import ResultError, merge, read_result

BAD_INPUT = 2  # exit status of a wrong command, key or file (cli.md)

EPILOG = """example:
  sphvv verify taylor_green --out results.h5
  sphvv report results.h5 --out report

  sphvv compare verification/baselines/operators.json now.h5 --json changes.json; sphvv report now.h5 --changes changes.json --out report

Writes DIR/index.html (one file, no network, no script), DIR/tables/*.csv, *.md, *.tex, DIR/figures/*.svg, *.pdf, and DIR/guide.tex, the same
report for paper: cd DIR && pdflatex guide && pdflatex guide.
Exit status: 0 the report is written, whatever its verdicts say; 2 a file or the output is not usable, and nothing is written."""


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="sphvv report", description="Turn result files into a page with tables and pictures.",
        epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE", help="a result file of sphvv (.h5 or its .json twin)")
    parser.add_argument("--out", required=True, metavar="DIR", help="folder for the page, its tables and its pictures")
    parser.add_argument("--changes", action="append", default=[], metavar="FILE.json",
                        help="what changed since a baseline: output of sphvv compare BASELINE FILE --json FILE.json; once for each comparison")
    parser.add_argument("--history", metavar="FILE.jsonl", help="nights to draw trends of: the history file of scripts/nightly")
    parser.add_argument("--json", metavar="FILE", help="write the list of written files, verdict counts and check counts; - is standard output")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    return parser.parse_args(arguments)


def refuse_unwritable(path, out):
    """Before anything is written, the folder of the page among it: a summary that cannot be written must not cost a page."""
    folder = os.path.dirname(path) or "."
    is_made = os.path.abspath(folder) in (os.path.abspath(out), os.path.abspath(os.path.join(out, "tables")))  # by the report, if need be
    if path != "-" and (os.path.isdir(path) or not (is_made or os.access(path if os.path.exists(path) else folder, os.W_OK))):
        raise ResultError(f"--json {path} cannot be written: {'it is a folder' if os.path.isdir(path) else 'no such folder, or no right to write there'}")


def write_summary(path, summary):
    """Writes the machine-readable summary to a file, or to standard output for `-`."""
    text = json.dumps(summary, indent=1, ensure_ascii=False) + "\n"
    if path == "-":
        sys.stdout.write(text)
        return
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text)


def main(arguments=None):
    """Runs the command and returns its exit status."""
    options = parse_arguments(arguments)
    try:
        if options.json:
            refuse_unwritable(options.json, options.out)
        results = merge([read_result(path) for path in options.files])
        # Imported late: matplotlib takes most of a second, which a refused file should not cost.
        from .changes import read_changes
        from .nights import read_history
        from .output import write_report
        from .page import build_report
        comparisons = [read_changes(path, results["files"]) for path in options.changes]
        report = build_report(results, comparisons, read_history(options.history) if options.history else [])
        write_report(options.out, report.files)
        if options.json:
            write_summary(options.json, {"index": os.path.join(options.out, "index.html"),
                                         "files": sorted(report.files), "verdicts": report.counts, "checks": report.checks})
    except ResultError as error:
        print(f"sphvv report: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        place = error.filename or options.out
        print(f"sphvv report: cannot write {place}: {(error.strerror or str(error)).lower()}", file=sys.stderr)
        return BAD_INPUT
    if not options.quiet and options.json != "-":
        print(os.path.join(options.out, "index.html"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
