"""What a call of `at` costs beyond solving: alone, and in a batch, whose elements go side by side.

    python python/benches/at.py

One alone is solved in one of the sixteen lanes that a batch fills, which takes as long as sixteen elements of a batch; what it takes beyond that
is the call. The careful way is what an element takes that no lane gets to: here each has a time of its own.
"""

from __future__ import annotations

import time

import numpy as np

import mechc

#: So many elements go side by side.
LANES = 16

FOUR_BAR = """mechanism four_bar {
    input theta = 90 deg + 30 rpm * t
    ground { point O = (0, 0) point Q = (80 mm, 0) }
    body crank at (0, 0, 90 deg) { point O = (0, 0) point C = (40 mm, 0) }
    body coupler at (0, 40 mm, 36 deg) { point C = (0, 0) point D = (100 mm, 0) point pen = (200 mm, 0) }
    body rocker at (80 mm, 0, 91 deg) { point Q = (0, 0) point D = (100 mm, 0) }
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, coupler.C)
    joint knee: revolute(coupler.D, rocker.D)
    joint pivot: revolute(ground.Q, rocker.Q)
    driver motor: rotation(main) = theta
    analysis from 0 s to 2 s every 20 ms
}
"""


def best(work, rounds=9):
    took = []
    for _ in range(rounds):
        began = time.perf_counter()
        work()
        took.append(time.perf_counter() - began)
    return min(took)


def main():
    m = mechc.parse(FOUR_BAR)
    # near where the mechanism stands by its text: all take the same way, in as many steps
    thetas = [1.5 + 0.0001 * k for k in range(LANES * 64)]
    array, times = np.array(thetas), np.linspace(0.001, 0.002, len(thetas))
    m.at(theta=0.3)
    alone = best(lambda: [m.at(theta=theta).q for theta in thetas]) / len(thetas)
    batch = best(lambda: m.at(theta=array).q) / len(thetas)
    far = best(lambda: [m.at(theta=0.3).q for _ in range(64)]) / 64
    spans = [(ends, best(lambda: m.at(theta=np.linspace(*ends, len(thetas))).q, rounds=3) / len(thetas)) for ends in ((0.2, 1.4), (0, 6))]
    careful = best(lambda: m.at(times, theta=array).q, rounds=3) / len(thetas)
    m.at(theta=array)
    print(f"m.at(theta=…).q, one at a time   {alone * 1e6:8.2f} µs")
    print(f"the same in a batch of {len(thetas)}      {batch * 1e6:8.2f} µs an element")
    print(f"beyond solving                   {(alone - LANES * batch) * 1e6:8.2f} µs")
    print(f"m.at(theta=0.3).q, farther off   {far * 1e6:8.2f} µs")
    for (low, high), took in spans:
        print(f"a batch from {low} to {high}          {took * 1e6:8.2f} µs an element")
    print(f"the careful way                  {careful * 1e6:8.2f} µs an element")


if __name__ == "__main__":
    main()
