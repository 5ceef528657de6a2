"""Completion of commands, options and their values, for bash and zsh."""
import re


def option_words(command):
    words = []
    for option in command["options"]:
        if not option["positional"]:
            words.append("--" + option["name"])
            words += ["-" + option["short_name"]] if "short_name" in option else []
    return words


def words_that_start_a_value(command):
    """Options that take a value, with the words that are known."""
    for option in command["options"]:
        if not option["positional"] and not option["flag"]:
            names = ["--" + option["name"]]
            names += ["-" + option["short_name"]] if "short_name" in option else []
            yield names, option.get("choices", [])


BASH = r"""# bash completion of vantage. Generated from the option table of the program.
_vantage() {
  local current=${COMP_WORDS[COMP_CWORD]} previous='' command='' first second
  ((COMP_CWORD == 0)) || previous=${COMP_WORDS[COMP_CWORD - 1]}
  first=${COMP_WORDS[1]-}
  second=${COMP_WORDS[2]-}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '@FIRST_WORDS@ help --help --version' -- "$current"))
    return
  fi
  command=$first
  case $first in
    help) COMPREPLY=($(compgen -W '@FIRST_WORDS@' -- "$current")); return ;;
@SECOND_WORDS@
  esac
  case "$command $previous" in
@VALUES@
  esac
  if [[ $current == -* ]]; then
    case $command in
@OPTIONS@
    esac
  fi
}
complete -o bashdefault -o default -F _vantage vantage
"""


def bash_completion(description):
    first_words, seconds = [], {}
    for command in description["commands"]:
        words = command["name"].split()
        first_words.append(words[0])
        if len(words) > 1:
            seconds.setdefault(words[0], []).append(words[1])
    second_words = [
        f"    {first})\n      if ((COMP_CWORD == 2)); then\n"
        f"        COMPREPLY=($(compgen -W '{' '.join(words)}' -- \"$current\"))\n        return\n"
        f"      fi\n      command=\"$first $second\" ;;"
        for first, words in seconds.items()]
    values, options = [], []
    for command in description["commands"]:
        name = command["name"]
        for names, choices in words_that_start_a_value(command):
            pattern = "|".join(f"'{name} {option}'" for option in names)
            reply = (f"COMPREPLY=($(compgen -W '{' '.join(choices)}' -- \"$current\")); "
                     if choices else "")
            values.append(f"    {pattern}) {reply}return ;;")
        words = " ".join(option_words(command))
        options.append(f"      '{name}') COMPREPLY=($(compgen -W '{words}' -- \"$current\")) ;;")
    text = BASH.replace("@FIRST_WORDS@", " ".join(dict.fromkeys(first_words)))
    for place, lines in (("@SECOND_WORDS@", second_words), ("@VALUES@", values),
                         ("@OPTIONS@", options)):
        text = text.replace(place, "\n".join(lines))
    return text


def zsh_quoted(text):
    """`text` inside single quotes, as a part of a specification of _arguments."""
    return re.sub(r"([\[\]:\\])", r"\\\1", text.split("\n")[0]).replace("'", "'\\''")


def zsh_specification(option):
    """One argument of _arguments."""
    if option["positional"]:
        place = "*" if option["list"] else ""
        return f"'{place}:{zsh_quoted(option.get('value', option['name']))}:_files'"
    value = ""
    if not option["flag"]:
        choices = option.get("choices")
        action = f"({' '.join(choices)})" if choices else "_files" if option["path"] else " "
        value = f":{zsh_quoted(option.get('value', 'VALUE'))}:{action}"
    repeated = "*" if option["list"] else ""
    names = ["--" + option["name"]]
    names += ["-" + option["short_name"]] if "short_name" in option else []
    return " ".join(f"'{repeated}{name}[{zsh_quoted(option['help'])}]{value}'" for name in names)


def zsh_completion(description):
    first_words, seconds, cases = {}, {}, []
    for command in description["commands"]:
        words = command["name"].split()
        first_words.setdefault(words[0], command["title"] if len(words) == 1 else "")
        if len(words) > 1:
            seconds.setdefault(words[0], []).append(f"'{words[1]}:{zsh_quoted(command['title'])}'")
        specifications = " \\\n        ".join(zsh_specification(o) for o in command["options"])
        cases.append(f"    '{command['name']}')\n      _arguments \\\n        {specifications} ;;")
    described = "\n".join(f"    '{word}:{zsh_quoted(title)}'" for word, title in first_words.items())
    second_cases = "\n".join(
        f"    {first})\n      if ((CURRENT == 2)); then\n"
        f"        local -a kinds=({' '.join(words)})\n        _describe kind kinds\n        return\n"
        f"      fi\n      command=\"$words[1] $words[2]\"\n      shift words\n      ((CURRENT--)) ;;"
        for first, words in seconds.items())
    return f"""#compdef vantage
# zsh completion of vantage. Generated from the option table of the program.
_vantage() {{
  local -a commands=(
{described}
  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  shift words
  ((CURRENT--))
  local command=$words[1]
  case $command in
{second_cases}
  esac
  case $command in
{chr(10).join(cases)}
  esac
}}
_vantage "$@"
"""
