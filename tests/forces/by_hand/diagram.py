"""The free-body diagrams of a mechanism at one time, and Newton's and Euler's equations for them.

For each body m a = sum of forces and I alpha = sum of moments about its centre of mass. The motion is known, so all that is unknown are the sizes of
the components that joints can transmit and of the drivers' efforts: a linear system, square because the mechanism is determined.
"""

from dataclasses import dataclass

import numpy as np

from .actions import Action, Push, Quantity, scaled_action
from .kinematics import Body, Point, vector


@dataclass
class Mass:
    """One body's mass: all that its text names, taken together."""

    mass: float
    centre: Point
    inertia: float  # about the centre

    @property
    def inertia_force(self):
        return [*(self.mass * self.centre.acceleration), self.inertia * self.centre.body.alpha]

    @property
    def kinetic(self):
        v = self.centre.velocity
        return self.mass * (v @ v) / 2 + self.inertia * self.centre.body.omega**2 / 2


@dataclass
class Solution:
    reactions: dict  # of each joint (force, moment) on its second body
    efforts: dict
    condition: float
    residual: float  # of the equations, relative to the largest force or moment in them


class Diagram:
    def __init__(self, t, cells):
        """`cells`: a row of the motion, by the names of its columns."""
        self.t, self.cells = t, cells
        self.ground = Body("ground", vector(0, 0), 0.0, vector(0, 0), 0.0, vector(0, 0), 0.0)
        self.gravity = vector(0, 0)
        self.masses, self.joints, self.drivers, self.loads, self.measures = {}, {}, {}, {}, {}

    def body(self, name, *masses):
        """The body of that name. `masses`: (mass, (x, y), inertia) in kg, m and kg m^2, the centre in the body's frame."""
        x, y, phi = (self.columns(f"{name}.{c}") for c in ("x", "y", "phi"))
        (px, vx, ax), (py, vy, ay), (p, w, a) = x, y, phi
        body = Body(name, vector(px, py), p, vector(vx, vy), w, vector(ax, ay), a)
        self.masses[name] = together(body, masses)
        return body

    def columns(self, name):
        return [self.cells[name + d] for d in ("", ".d", ".dd")]

    def joint(self, name, joint):
        self.joints[name] = joint

    def driver(self, name, *terms):
        """A driver or constraint: K, or (factor, K) for each K in it, the factors those of small changes of left side less right side."""
        self.drivers[name] = [term if isinstance(term, tuple) else (1.0, term) for term in terms]

    def load(self, name, size, on: Quantity):
        self.loads[name] = (size, on)

    def measure(self, name, of):
        """A column of the text's own: a function of the solution."""
        self.measures[name] = of

    def solve(self):
        unknowns = [action for joint in self.joints.values() for action in joint.unknowns]
        unknowns += [scaled_sum(terms) for terms in self.drivers.values()]
        matrix = np.column_stack([self.sums(action) for action in unknowns])
        assert matrix.shape[0] == matrix.shape[1], f"{matrix.shape[0]} equations for {matrix.shape[1]} unknowns"
        sizes, condition = solved(matrix, self.inertia() - self.known())
        terms = np.abs(matrix) @ np.abs(sizes)
        residual = np.max(np.abs(matrix @ sizes - self.inertia() + self.known())) / max(np.max(terms), 1e-300)
        sizes = list(sizes)
        reactions = {name: joint.reaction([sizes.pop(0) for _ in joint.unknowns]) for name, joint in self.joints.items()}
        return Solution(reactions, dict(zip(self.drivers, sizes)), condition, residual)

    def inertia(self):
        """m a and I alpha, body by body."""
        return np.concatenate([m.inertia_force for m in self.masses.values()])

    def known(self):
        """Weights and loads, body by body."""
        weights = [Push(m.centre.body, m.centre.place, m.mass * self.gravity) for m in self.masses.values()]
        return self.sums(weights) + sum(size * self.sums(on.action) for size, on in self.loads.values())

    def sums(self, action: Action):
        """Forces and moments about the centres of mass, body by body. What holds the ground is nobody's concern."""
        rows = {name: np.zeros(3) for name in self.masses}
        for push in action:
            if push.body is not self.ground:
                rows[push.body.name] += [*push.force, push.moment(self.masses[push.body.name].centre.place)]
        return np.concatenate(list(rows.values()))

    def energy_and_quantities(self):
        """The energy, then the quantities that efforts and loads work on."""
        energy = sum(m.kinetic - m.mass * (self.gravity @ m.centre.place) for m in self.masses.values())
        driven = [quantity.value for terms in self.drivers.values() for _, quantity in terms]
        return np.array([energy, *driven, *(on.value for _, on in self.loads.values())])

    def generalized_forces(self, solution):
        """On these quantities, in the same order."""
        efforts = [solution.efforts[name] * factor for name, terms in self.drivers.items() for factor, _ in terms]
        return [*efforts, *(size for size, _ in self.loads.values())]


def together(body, masses):
    """Several masses of one body as one: the common centre, and the parallel axes' theorem."""
    total = sum((m for m, _, _ in masses), 0.0)
    if total == 0.0:
        return Mass(0.0, body.point(0, 0), sum((i for _, _, i in masses), 0.0))
    centre = sum(m * vector(*c) for m, c, _ in masses) / total
    offsets = [vector(*c) - centre for _, c, _ in masses]
    inertia = sum(i + m * (d @ d) for (m, _, i), d in zip(masses, offsets))
    return Mass(total, body.point(*centre), inertia)


def scaled_sum(terms):
    return [push for factor, quantity in terms for push in scaled_action(factor, quantity.action)]


def solved(matrix, right):
    """The solution, and the condition number of the matrix after its rows and columns, which have different units, were brought to size 1."""
    rows = 1 / np.max(np.abs(matrix), axis=1)
    columns = 1 / np.max(np.abs(matrix * rows[:, None]), axis=0)
    even = matrix * rows[:, None] * columns
    scaled = np.linalg.solve(even, right * rows)
    scaled += np.linalg.solve(even, right * rows - even @ scaled)  # one step of refinement
    return scaled * columns, np.linalg.cond(even)
