"""How near map matching comes to the truth and what it costs: goals beside what was measured."""

import re
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
NETWORKS = SOURCE / "sample_data" / "networks"

NOTE = """Drives over sample_data/networks with known truth: a lane 1.5 to 3.5 m beside the map's line, corners cut, stops; position errors
forgotten over 30 s (standard deviation of an axis *sigma*) and a tenth of it new at every fix; latency of 0 to 2.5 s; odometer at
10 Hz wrong by 0.5 %; gyro at 50 Hz with a wandering bias.

* A metre of the route is *right* if the matched place lies on the true edge in the true direction, or elsewhere on the true route within
  10 m (twice sigma, if that is more). *The same edge* leaves that out.
* *Along it* is the error of the place along the map's line; *middle* is signed.
* *RMF* is missed and wrong length over true length, edge by edge.
* *ECE* is the mean difference of confidence and share of right length in tenths of confidence; *sure* is the length at 0.95 or more.
* *Deleted edges* make 5 % of what a drive drove; 10 m at their ends are not counted. A *neighbour* is a road of the map abreast of the
  car, within 30 m and 30 degrees.
"""


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def output_of(words):
    print(f"{Path(words[0]).name}", file=sys.stderr, flush=True)
    return subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, text=True, check=True).stdout


def goals_and_text(output):
    """Lines of goal.hpp apart from the tables."""
    lines = output.splitlines()
    goals = [line.split("\t")[1:] for line in lines if line.startswith("goal\t")]
    return goals, "\n".join(line for line in lines if not line.startswith("goal\t")) + "\n"


def number(pattern, text):
    found = re.search(pattern, text)
    if not found:
        sys.exit(f"match_report.py: kubicka_bench printed nothing like '{pattern}'")
    return float(found.group(1))


def kubicka_goals(text):
    def line(name):
        found = re.search(re.escape(name) + r"\s+" + r"\s+".join([r"([\d.]+)"] * 5), text)
        if not found:
            sys.exit(f"match_report.py: kubicka_bench printed no line '{name}'")
        return [float(one) for one in found.groups()]

    wcf, _, rmf, empty, speed = line("as recorded, 1 s")
    plain = line("plain Newson-Krumm, 1 s")
    goals = [["WCF", ">= 0.9950", f"{wcf:.4f}", f"{plain[0]:.4f}"],
             ["RMF", "<= 0.012", f"{rmf:.4f}", f"{plain[2]:.4f}"],
             ["empty tracks", "0", f"{empty:.0f}", f"{plain[3]:.0f}"],
             ["positions/s", ">= 300,000", f"{speed:,.0f}", f"{plain[4]:,.0f}"]]
    for step, loss in ((5, 0.003), (15, 0.01), (30, 0.03)):
        goals.append([f"WCF lost by a position each {step} s", f"<= {loss}", f"{wcf - line(f'each {step} s')[0]:.4f}", ""])
    goals += [["confidence: calibration error", "<= 0.02", f"{number(r'calibration error ([0-9.]+)', text):.3f}", ""],
              ["confidence: length at 0.95 or more", ">= 97 %", f"{number(r'or above ([0-9.]+) %', text):.1f} %", ""],
              ["confidence: of that length wrong", "<= 0.3 %", f"{number(r'of that ([0-9.]+) % wrong', text):.2f} %", ""],
              ["deleted edges: recall", ">= 0.95", f"{number(r'recall ([0-9.]+)', text):.3f}", ""],
              ["deleted edges: precision", ">= 0.98", f"{number(r'precision ([0-9.]+)', text):.3f}", ""]]
    return [[f"Kubička: {what}", *rest] for what, *rest in goals]


def match_report(build, kubicka):
    """\\param kubicka  the folder of that data set, or None."""
    programs = build / "tests" / "bench"
    truth_goals, truth = goals_and_text(output_of([programs / "match" / "simulated_truth", NETWORKS]))
    size_goals, size = goals_and_text(output_of([programs / "match" / "large_network", NETWORKS]))
    goals, recorded = [], ""
    if kubicka:
        found = output_of([programs / "kubicka_bench", kubicka, "--plain", "--deleted"])
        goals = kubicka_goals(found)
        recorded = f"### Recorded trips\n\nThe set of Kubička et al. (doi:10.5281/zenodo.57731), positions alone.\n\n```\n{found}```\n\n"
    goals += truth_goals + size_goals
    return ("### Wanted and measured\n\n" + table(["what", "wanted", "measured", "plain Newson-Krumm"], goals) +
            "\n" + recorded + NOTE + "\n" + truth + "\n" + size)
