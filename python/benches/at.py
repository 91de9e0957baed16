"""What a call of `at` costs beyond solving: alone, and in a batch, of which each element is solved alike.

    python benches/at.py
"""

from __future__ import annotations

import time

import numpy as np

import mechc

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


def best(work, rounds=7):
    took = []
    for _ in range(rounds):
        began = time.perf_counter()
        work()
        took.append(time.perf_counter() - began)
    return min(took)


def main():
    m = mechc.parse(FOUR_BAR)
    thetas = [1.5 + 0.001 * k for k in range(1000)]
    array = np.array(thetas)
    m.at(theta=0.3)
    alone = best(lambda: [m.at(theta=theta).q for theta in thetas]) / len(thetas)
    batch = best(lambda: m.at(theta=array).q) / len(thetas)
    print(f"m.at(theta=…).q, one at a time   {alone * 1e6:8.2f} µs")
    print(f"the same in a batch of 1000      {batch * 1e6:8.2f} µs an element")
    print(f"beyond solving                   {(alone - batch) * 1e6:8.2f} µs")


if __name__ == "__main__":
    main()
