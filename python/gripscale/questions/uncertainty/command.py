"""`gripscale uncertainty CASE.toml`: the answer with the errors of its inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from gripscale.questions import terminal

if TYPE_CHECKING:
    import xarray as xr


@terminal.case_command
def uncertainty_command(
    case: terminal.CasePath,
    samples: Annotated[
        int | None, terminal.option("Samples, of all inputs at once; 200 by default.")
    ] = None,
    model: Annotated[
        str | None,
        terminal.option(
            "direct (contact of the whole profile, the default where one was measured), chain or "
            "both."
        ),
    ] = None,
    without: Annotated[
        list[str] | None,
        terminal.option(
            "A source to be left out: height_noise, cleaning, profile, grid, modulus, "
            "bulk_modulus, equilibrium_modulus, temperature, pressure, load_time, cut_off, waves. "
            "May be given several times.",
            metavar="NAME",
        ),
    ] = None,
    ranges: Annotated[
        list[str] | None,
        terminal.option(
            "What is known of a source, in place of its default: two ends as "
            "bulk_modulus='1.5 GPa:3 GPa', cut_off='50 um:200 um', cleaning=1.5:10 (height per "
            "step that is a spike), load_time=0.5:2 (factors), equally likely values as "
            "waves=6,8, or the standard error of what is not sampled without it: "
            "height_noise='5 um', temperature='2 K', pressure='3 %'. May be given several times.",
            "--range",
            metavar="NAME=VALUES",
        ),
    ] = None,
    vary: Annotated[
        str | None,
        terminal.option(
            "Speeds or pressures, the same samples at each: speed=0.003:30:log9.",
            metavar="NAME=VALUES",
        ),
    ] = None,
    block_length: Annotated[
        str | None,
        terminal.option(
            "Length of the blocks of profiles that are drawn, such as '120 mm'; four of the "
            "largest waves by default."
        ),
    ] = None,
    tolerance: Annotated[
        float | None,
        terminal.option(
            "Estimated relative error of each direct contact; by default that of its first "
            "full grid, about a tenth."
        ),
    ] = None,
    seed: Annotated[
        int | None, terminal.option("Seed of the random numbers; 0 by default.")
    ] = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
    cluster: terminal.Cluster = None,
) -> None:
    """Answer with what is not known of the inputs, and what matters most; resumes where stopped.

    Options go before what the case states in its table [uncertainty].
    """
    from gripscale.core import checks
    from gripscale.core.parallel import worker_count
    from gripscale.experiment.solve import PROCESSES
    from gripscale.half_space.model import DirectContact
    from gripscale.questions.answer.page import answer_lines
    from gripscale.questions.uncertainty.propagation import SAMPLED_OVER, Plan, propagate
    from gripscale.questions.uncertainty.question import SampledAnswer
    from gripscale.questions.uncertainty.sampled_inputs import length
    from gripscale.questions.uncertainty.sources import BOTH
    from gripscale.questions.vary.axis import parse_axes, values_by_name

    asked: dict[str, Any] = {
        "models": None if model is None else BOTH[checks.one_of("model", model, BOTH)],
        "vary": None if vary is None else parse_axes([vary], SAMPLED_OVER),
        "without": without or None,
        "ranges": values_by_name(ranges or (), "range", "cut_off=50 um:200 um"),
        "block_length": None if block_length is None else length(block_length),
    }
    work = terminal.CaseCommand(case)
    plan = Plan.of(work.case, **asked, samples=samples, seed=seed, tolerance=tolerance)
    if cluster is None and DirectContact.name in plan.models and worker_count(workers) > 2:
        cluster = PROCESSES
    work.open_results(output, "uncertainty", f"Uncertainty of {work.file.path}")

    def print_answer(answer: xr.Dataset) -> None:
        lead, *_ = answer_lines(answer)
        number = lead.removeprefix("Answer: ")
        lines = ["", f"Without the errors of the inputs: {number}", "Solving the samples ..."]
        terminal.print_parts(work.console, lines)

    data = propagate(plan, client=cluster, on_answer=print_answer, **work.solving(workers))
    work.finish(SampledAnswer(data), "tables and figures")
