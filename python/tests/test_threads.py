"""Long calls let other threads run, may run in several, and end on Ctrl-C."""

import signal
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from types import FrameType

import numpy as np
import pytest

import partsight


def test_another_thread_goes_on_during_an_inspection(
    library: partsight.Library, frame: partsight.SimulatedFrame
) -> None:
    scene = frame.scene()
    turns = 0
    is_done = threading.Event()

    def inspect_until_the_other_had_a_turn() -> bool:
        for _ in range(200):
            before = turns
            partsight.inspect(scene, library)
            if turns > before:
                return True
        return False

    # No thread has to hand the interpreter over by itself, so a turn during a call means that the call did.
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    try:
        with ThreadPoolExecutor(1) as pool:
            asked = pool.submit(inspect_until_the_other_had_a_turn)
            asked.add_done_callback(lambda _: is_done.set())
            while not is_done.is_set():
                turns += 1
                time.sleep(0.001)
        assert asked.result()
    finally:
        sys.setswitchinterval(interval)


def test_threads_share_a_library_and_get_the_same_results(tmp_path_factory: pytest.TempPathFactory) -> None:
    library = partsight.Library.create(tmp_path_factory.mktemp("shared"))
    library.enrol(partsight.simulate_frame("fender", seed=1).scene(), "fender")
    scenes = [partsight.simulate_frame("fender", seed=seed).scene() for seed in range(2, 5)]

    def poses() -> list[bytes]:
        found = [partsight.inspect(scene, library).pose for scene in scenes]
        return [pose.camera_from_part.tobytes() if pose else b"" for pose in found]

    expected = poses()
    assert all(expected)
    with ThreadPoolExecutor(4) as pool:
        asked = [pool.submit(poses) for _ in range(8)]
        # A part that cannot be taken for a fender changes nothing for those who inspect meanwhile.
        library.enrol(partsight.simulate_frame("grille", seed=1).scene(), "grille")
        assert len(library) == 2
        assert all(one.result() == expected for one in asked)


class Interrupted(Exception):
    """What the signal handler of the test raises."""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no timers that send signals")
def test_a_signal_ends_a_long_call() -> None:
    random = np.random.default_rng(1)
    # So many points that their preparation alone takes longer than a call goes without looking for signals.
    source, target = random.normal(size=(2, 300_000, 3))
    ended_by: list[str] = []

    def interrupt(_number: int, _frame: object) -> None:
        raise Interrupted

    def observe(_frame: FrameType, event: str, called: object) -> None:
        if called is partsight.align:
            ended_by.append(event)

    before = signal.signal(signal.SIGVTALRM, interrupt)
    sys.setprofile(observe)
    try:
        with pytest.raises(Interrupted):
            # In processor time: on a busy machine it must not run out before the call.
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.02)
            partsight.align(source, target, method="icp-ga")
    finally:
        sys.setprofile(None)
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
    # Raised by the call itself, and not by the interpreter once it had returned.
    assert ended_by == ["c_call", "c_exception"]
