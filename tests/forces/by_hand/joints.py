"""What each kind of joint can transmit, found by looking at the two bodies cut apart.

Each function gives a `Joint`: an action for each unknown component (positive as it works on the second body, opposite on the first), the place
that the reaction is reduced to, and numbers that vanish while the joint holds, so that geometry written here and motion computed elsewhere
are known to belong together.
"""

from dataclasses import dataclass, field

import numpy as np

from .actions import Action, couple_between, force_between
from .kinematics import Body, cross, turned, unit, vector

RIGHT, UP = vector(1, 0), vector(0, 1)


@dataclass
class Joint:
    second: Body
    unknowns: list[Action]
    reference: np.ndarray
    has_torque: bool
    gaps: list[float] = field(default_factory=list)

    def reaction(self, sizes):
        """On the second body, reduced to the reference: (force, moment)."""
        pushes = [(size, p) for size, action in zip(sizes, self.unknowns) for p in action if p.body is self.second]
        force = sum(size * p.force for size, p in pushes)
        return force, sum(size * p.moment(self.reference) for size, p in pushes)


def revolute(p, q):
    """A pin transmits a force in any direction, and no moment."""
    components = [force_between(p.body, q.body, q.place, e) for e in (RIGHT, UP)]
    return Joint(q.body, components, q.place, False, [*(p.place - q.place), *(p.velocity - q.velocity)])


def weld(p, q, angle):
    """A glued joint transmits everything."""
    pin = revolute(p, q)
    components = [*pin.unknowns, couple_between(p.body, q.body)]
    return Joint(q.body, components, q.place, True, [*pin.gaps, q.body.phi - p.body.phi - angle])


def translational(a, b):
    """Smooth flanks transmit a force across the way, and a moment since they are long."""
    components = [force_between(a.body, b.body, b.place, a.normal), couple_between(a.body, b.body)]
    gaps = [a.normal @ (b.place - a.place), cross(a.direction, b.direction)]
    return Joint(b.body, components, b.place, True, gaps)


def revolute_revolute(p, q, length):
    """A link without mass is in equilibrium under two forces, which are along it then; so either end is on the line of both."""
    e = unit(q.place - p.place)
    strut = force_between(p.body, q.body, q.place, e)
    return Joint(q.body, [strut], q.place, False, [np.hypot(*(q.place - p.place)) - length])


def revolute_translational(p, slot, offset=0.0):
    """A pin presses on a smooth flank of the slot: a force across the slot, at the pin."""
    press = force_between(p.body, slot.body, p.place, slot.normal)
    return Joint(slot.body, [press], slot.place, True, [slot.normal @ (p.place - slot.place) - offset])


def gear(c, d):
    return gears(c, d, c.radius, d.radius)


def internal_gear(c, d):
    """As `gear`; from the inside a gear's own radius counts against the other's."""
    return gears(c, d, c.radius, -d.radius)


def gears(c, d, first, second):
    """Teeth without pressure angle: a force along the common tangent at the pitch point, which divides the line of centres in the ratio of
    the radii (so its distances from both centres are the lever arms)."""
    line = d.centre.place - c.centre.place
    tangent = turned(unit(line))
    pitch = c.centre.place + first / (first + second) * line
    spin = tangent @ (d.centre.velocity - c.centre.velocity) / np.hypot(*line)
    slip = first * (c.body.omega - spin) + second * (d.body.omega - spin)
    return Joint(d.body, [force_between(c.body, d.body, pitch, tangent)], d.centre.place, True, [slip])


def rack_pinion(c, rack, side):
    """A force along the rack, at the point of the circle next to it. `side`: +1 where the centre is left of the rack's axis, -1 right."""
    pitch = c.centre.place - side * c.radius * rack.normal
    rolling = c.centre.velocity - c.body.omega * side * c.radius * turned(rack.normal)
    of_rack = rack.point.velocity + rack.body.omega * turned(pitch - rack.place)
    teeth = force_between(c.body, rack.body, pitch, rack.direction)
    return Joint(rack.body, [teeth], rack.place, True, [rack.direction @ (rolling - of_rack)])


def point_follower(p, k):
    """A point on a smooth curve: a force across the curve."""
    press = force_between(p.body, k.body, k.place, turned(k.tangent))
    return Joint(k.body, [press], k.place, False, [*(k.place - p.place)])


def cam(k, m):
    """Two smooth curves: a force along their common normal."""
    press = force_between(k.body, m.body, m.place, turned(m.tangent))
    return Joint(m.body, [press], m.place, False, [*(m.place - k.place), cross(k.tangent, m.tangent)])


def flat_follower(k, face):
    """A curve under a smooth face: a force across the face."""
    press = force_between(k.body, face.body, k.place, face.normal)
    gaps = [face.normal @ (k.place - face.place), cross(k.tangent, face.direction)]
    return Joint(face.body, [press], k.place, False, gaps)
