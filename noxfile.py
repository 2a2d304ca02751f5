# /// script
# dependencies = ["nox"]
# ///
"""The commands of the Makefile where there is no make, as on Windows: `nox -s tests`.

Each session has an environment of its own with the locked versions and the package built into it.
"""

import nox

nox.needs_version = ">=2025.2.9"
nox.options.default_venv_backend = "uv|virtualenv"


def build(session: nox.Session) -> None:
    """Install the locked libraries and the package with its kernel."""
    session.install("-r", "requirements.lock")
    session.run("maturin", "develop", "--release", "--locked", "--quiet")


@nox.session
def lint(session: nox.Session) -> None:
    """Style and types of Rust and Python."""
    build(session)
    session.run("cargo", "fmt", "--check", external=True)
    warnings = ("--", "-D", "warnings")
    session.run("cargo", "clippy", "--locked", "--all-targets", *warnings, external=True)
    session.run("ruff", "check", ".")
    session.run("ruff", "format", "--check", ".")
    session.run("mypy")


@nox.session
def tests(session: nox.Session) -> None:
    """Tests of the kernel and of the package."""
    build(session)
    session.run("cargo", "test", "--locked", external=True)
    # one BLAS kernel on all machines: sums in the same order, for the numbers that tests keep
    numbers = {"OPENBLAS_CORETYPE": "Haswell", "OPENBLAS_NUM_THREADS": "1"}
    session.run("pytest", "-q", "-n", "logical", *session.posargs, env=numbers)


@nox.session(default=False)
def verify(session: nox.Session) -> None:
    """Compare with references, for hours."""
    build(session)
    session.run("pytest", "-q", "-m", "verification", *session.posargs)


@nox.session(default=False)
def docs(session: nox.Session) -> None:
    """Build the documentation site into results/site."""
    build(session)
    session.run("mkdocs", "build", "--strict", env={"NO_MKDOCS_2_WARNING": "1"})


@nox.session(default=False)
def example(session: nox.Session) -> None:
    """Solve the shipped road and rubber."""
    build(session)
    case = "examples/road_and_tread/case.toml"
    session.run("gripscale", "run", case, "--output", "results/road_and_tread")


if __name__ == "__main__":
    nox.main()
