"""The list of mechanisms that are drawn as free-body diagrams, and what several of the drawings use.

In the drawings all numbers of the texts are written again, in SI; nothing is read from the texts. `joint(...)` and `driver(...)` say what acts
between which bodies, `load(...)` how much of it there is. Of a driver or constraint that is no single quantity, the terms are what its left side less
its right changes by, for small changes of the quantities in it.
"""

import numpy as np

INCH, POUND, GRAVITY = 0.0254, 0.45359237, 9.80665
MECHANISMS = {}


def mechanism(draw):
    """Lists a drawing under the name of its text."""
    MECHANISMS[draw.__name__] = draw
    return draw


def size(joint):
    """A measure: the size of a joint's force."""
    return lambda solution: np.hypot(*solution.reactions[joint][0])


def power(driver, rate):
    """A measure: a driver's effort times a rate."""
    return lambda solution: solution.efforts[driver] * rate


def step5(u, u0, v0, u1, v1):
    """The quintic from v0 at u0 to v1 at u1, flat outside."""
    s = min(max((u - u0) / (u1 - u0), 0.0), 1.0)
    return v0 + (v1 - v0) * s**3 * (10 - 15 * s + 6 * s**2)
