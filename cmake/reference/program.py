"""The commands and options of a vantage program, as it prints them itself."""
import json
import subprocess


def printed_json(program, *words):
    text = subprocess.run([program, *words, "--help-json"], check=True, stdout=subprocess.PIPE).stdout
    return json.loads(text)


def read_program(program):
    """The program's version, summary, exit codes and commands, each with its options."""
    description = printed_json(program)
    description["commands"] = [
        {**command, **printed_json(program, *command["name"].split())}
        for command in description["commands"]]
    return description


def page_name(command):
    """vantage-scene-build of `vantage scene build`."""
    return "vantage-" + command["name"].replace(" ", "-")


def groups(command):
    """Pairs of a heading and its options, in order; positional arguments first."""
    found = {}
    for option in command["options"]:
        found.setdefault("Arguments" if option["positional"] else option["group"], []).append(option)
    return sorted(found.items(), key=lambda group: group[0] != "Arguments")


def usage(command):
    """One line, as `vantage match [OPTIONS] LEFT RIGHT [OTHER ...]`."""
    words = ["vantage", command["name"], "[OPTIONS]"]
    for option in command["options"]:
        if option["positional"]:
            word = option.get("value", option["name"]) + (" ..." if option["list"] else "")
            words.append(word if option["required"] else f"[{word}]")
    return " ".join(words)


def default_text(option):
    """The default as users write it; empty where there is none, or the help names it."""
    value = option.get("default", "")
    return value if isinstance(value, str) else json.dumps(value)
