"""What the program says of its own studies: names, commands and budgets."""

import json
import subprocess


class Study:
    """One line of `sphvv list studies`. `cost` is its budget: seconds of processor time, of all threads."""

    def __init__(self, entry):
        self.name = entry["name"]
        self.tier = entry["tier"]
        self.cost = float(entry["cost"])
        self.command = [entry["command"]] + ([self.name] if self.name != entry["command"] else [])
        if entry["command"] in ("verify", "operators"):
            self.command += ["--tier", self.tier]

    @property
    def family(self):
        """What a baseline holds together: the case of a ladder, or the command."""
        return self.name.split("/")[0]

    @property
    def stem(self):
        return self.name.replace("/", ".")


def listed(sphvv, tier=None):
    """The studies of a tier, or of all, in the order of the list. Throws ValueError, a sentence, for a program that is not sphvv."""
    done = subprocess.run([sphvv, "list", "studies", "--json", "-"], check=False, capture_output=True, text=True)
    try:
        return [study for study in map(Study, json.loads(done.stdout)) if tier in (None, study.tier)]
    except (ValueError, KeyError, TypeError):
        raise ValueError(f"{sphvv} does not list its studies, so it is no sphvv of this version") from None


def chosen(studies, names):
    """Those of that name or of that case; all if no name is given. Throws ValueError, a sentence, for a name that none has."""
    known = [study.name for study in studies] + sorted({study.family for study in studies})
    for name in names:
        if name not in known:
            raise ValueError(f"there is no study or case '{name}' in this tier; accepted: {', '.join(dict.fromkeys(known))}")
    return [study for study in studies if not names or study.name in names or study.family in names]
