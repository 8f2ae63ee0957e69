"""Scripts that have a shell ask the command what may come next."""

from pvlvrt_compliance.errors import UsageError, did_you_mean

SHELLS = ("bash", "zsh", "fish", "powershell")

PROGRAM = "pvlvrt-check"
ASKED_BY = "_PVLVRT_CHECK_COMPLETE"
"""The variable by which typer's scripts ask."""

# bash cuts a line into words at "=" and ":", too, which are part of ours: the line itself is handed on, of which typer
# takes the last word (-1) unless it has not begun; and of every answer the part before the last cut is taken away.
_BASH = """\
_pvlvrt_check_completion() {
    local IFS=$'\\n' line="${COMP_LINE:0:COMP_POINT}" breaks="${COMP_WORDBREAKS//[^=:]/}" word last=-1 cut="" k
    word="${line##*[[:space:]]}"
    [[ -n "$word" ]] || last=1000000
    [[ -n "$breaks" && "$word" == *["$breaks"]* ]] && cut="${word%"${word##*["$breaks"]}"}"
    COMPREPLY=( $(COMP_WORDS="$line" COMP_CWORD=$last VARIABLE=complete_bash "$1" 2>/dev/null) )
    for k in "${!COMPREPLY[@]}"; do COMPREPLY[k]="${COMPREPLY[k]#"$cut"}"; done
    [[ ${#COMPREPLY[@]} -eq 1 && "${COMPREPLY[0]}" == *= ]] && compopt -o nospace 2>/dev/null
    return 0
}
complete -o default -F _pvlvrt_check_completion PROGRAM
"""


def script_for(shell: str) -> str:
    """The script of a shell.

    Raises
    ------
    UsageError
        When there is none for it.
    """
    if shell not in SHELLS:
        raise UsageError(f"completion {shell}: allowed are {', '.join(SHELLS)}{did_you_mean(shell, SHELLS)}")
    if shell == "bash":
        return _BASH.replace("VARIABLE", ASKED_BY).replace("PROGRAM", PROGRAM)
    from typer.completion import get_completion_script  # type: ignore[attr-defined]  # nor have its scripts

    return get_completion_script(prog_name=PROGRAM, complete_var=ASKED_BY, shell=shell) + "\n"
