"""The report of sphvv: result files in, one self-contained page with its tables and pictures out.

    python3 -m sphvv_report results.h5 --out report

Data flows one way: results (read and check) -> findings (what the verdicts amount to) -> tables, figures -> page -> output.
What `sphvv operators` found has its chapters in operators and checks; ladders holds the tables that they share with page.
"""
