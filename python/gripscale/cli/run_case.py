"""Running the chain of a case file into its results folder, without a console.

run = run_case("case.toml", output="results")
run.dynamic.friction
"""

from __future__ import annotations

from pathlib import Path

from gripscale.case_file import folder
from gripscale.case_file.prepare import read_case
from gripscale.case_file.read import CaseFile, read_case_file
from gripscale.io.folders import require_writable
from gripscale.questions.chain import events
from gripscale.questions.chain.events import OnEvent
from gripscale.questions.chain.run import ChainRun, planned


def run_case(
    file: CaseFile | str | Path,
    *,
    output: str | Path | None = None,
    on_event: OnEvent | None = None,
    fresh: bool = False,
    run: ChainRun | None = None,
) -> ChainRun:
    """Solve the chain of waves of a case file.

    A wave that did not converge ends its prediction, which is named in `failures`. Raises
    `FileError` or `InputError` for what cannot be read, used or written.

    Parameters
    ----------
    file : path or CaseFile
        The case file.
    output : path, optional
        Folder for the result files, written as the waves are solved, with the case and its files,
        so that it runs from there. Results of an earlier run are replaced, unless they are of
        exactly this case: then what was finished is taken up and not solved again. Without it
        nothing is written.
    on_event : callable, optional
        Called with each event of `gripscale.questions.chain.events`: start, waves, predictions,
        files.
    fresh : bool, optional
        Take nothing up.
    run : ChainRun, optional
        The run of the case in this folder, where the case is read already.
    """
    file = file if isinstance(file, CaseFile) else read_case_file(file)
    emit = on_event or (lambda event: None)
    target = None if output is None else Path(output)
    if target is not None:
        require_writable(target)
    run = ChainRun.of(read_case(file), target, fresh=fresh) if run is None else run
    case = run.case
    iterated = case.conditions is not None and case.conditions.iterated
    emit(events.RunStarted(tuple(planned(case)), len(case.surface.sines), iterated))
    if target is not None:
        replaced = folder.earlier_run(target, run.kept_files)
        if replaced:
            emit(events.ResultsReplaced(replaced))
        folder.prepare(target, file, run.kept_files)
    run.solve(on_event)
    return run
