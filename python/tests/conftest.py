"""What several tests use: the shipped parts, a simulated frame, and skips that a variable turns into failures."""

import importlib.util
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

import partsight

CHECKOUT = Path(__file__).resolve().parents[2]


def skip(variable: str, why: str) -> None:
    """Skips the test, or fails it where the variable says that nothing may be missing."""
    if os.environ.get(variable) == "1":
        pytest.fail(f"{variable}=1, and {why}")
    pytest.skip(why)


def require(package: str) -> None:
    """Skips the test where a package is missing."""
    if importlib.util.find_spec(package) is None:
        skip("PARTSIGHT_REQUIRE_PYTHON_PACKAGES", f"{package} is not installed")


@pytest.fixture(scope="session", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A home of its own: nothing of the person's library, recipes or history is read or changed."""
    folder = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", str(folder))
        patch.delenv("XDG_DATA_HOME", raising=False)
        patch.setenv("MPLBACKEND", "Agg")
        yield folder


@pytest.fixture(scope="session")
def library() -> partsight.Library:
    return partsight.Library.open(CHECKOUT / "reference_parts")


@pytest.fixture(scope="session")
def frame() -> partsight.SimulatedFrame:
    return partsight.simulate_frame("fender", seed=1)
