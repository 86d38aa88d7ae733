"""Accelerations written once more, straight from Newton-Euler, in plain Python: no code shared with the solver."""

import cmath
import math

import numpy as np
from scipy.optimize import brentq

from reference.problem import GRAVITY, Scene
from reference.problem.friction import VelocityFriction


class RefusalError(Exception):
    """The motion left what the equations describe: rim, contact lost, Painleve."""


class Law:
    """
    One scene at one phase pair. Positions relative to the plate; (ex, ey) is the horizontal unit slip direction.

    `platform` solves diag(m1, m1, m_sum) a = (f - m1 u, -m_sum (g + zeta'')) + N (n - mu w), n.a = |v|^2 / rho for
    the exact equations, or takes (4.3) as printed for the small ones.
    """

    def __init__(self, scene: Scene, phase: tuple[float, float], equations: str) -> None:
        assert equations in ("exact", "small")
        self.exact = equations == "exact"
        self.rho = scene.radius
        self.mass = [float(m) for m in scene.masses]
        self.total = sum(self.mass)
        self.links = [(float(kx), float(ky)) for kx, ky in scene.stiffness]
        self.dampers = [(float(cx), float(cy)) for cx, cy in scene.damping]
        self.count = len(self.mass)
        friction = scene.isolator.friction
        self.slow, self.fast, self.rate, self.exponent, self.reference = 0.0, 0.0, 0.0, 0.0, self.total * GRAVITY
        if isinstance(friction, VelocityFriction):
            self.slow, self.fast, self.rate = friction.slow, friction.fast or 0.0, friction.rate or 0.0
            self.exponent = friction.load_exponent or 0.0
            self.reference = friction.reference_load or self.reference
        self.mu = self.slow or scene.friction_coefficient  # at rest, under the reference load
        self.lubricated = scene.lubricated
        self.duration = scene.duration
        self.swing = 0.0  # largest sqrt(x1^2 + y1^2)/rho of the states accepted so far
        load = scene.excitation
        self.breaks = [scene.duration]  # s, where the ground acceleration has a kink, and the end
        self.record = scene.record if scene.recorded else None
        # s, step of a platform at rest, which alone has nothing to integrate: 1/16 of a period
        self.longest_rest = math.inf if scene.recorded else min(load.periods) / 16.0
        if self.record is not None:
            self.breaks = [float(t) for t in self.record[:, 0] if 0.0 < t < scene.duration] + self.breaks
            return
        exponents = [complex(-load.decay[i], 2.0 * math.pi / load.periods[i]) for i in range(2)]
        self.waves = [(exponents[i], phase[i], scene.amplitudes[:, i].tolist()) for i in range(2)]

    def accept(self, x: float, y: float, normal: float) -> None:
        if not normal > 0.0:
            raise RefusalError("contact lost")
        self.swing = max(self.swing, math.hypot(x, y) / self.rho)

    def next_break(self, t: float) -> float:
        return next((instant for instant in self.breaks if instant > t), self.duration)

    def ground(self, t: float) -> tuple[float, float, float]:
        if self.record is not None:
            x, y, z = (float(np.interp(t, self.record[:, 0], self.record[:, k], right=0.0)) for k in (1, 2, 3))
            return x, y, z
        first, second = (cmath.exp(s * t + 1j * alpha).real for s, alpha, _ in self.waves)
        a, b = self.waves[0][2], self.waves[1][2]
        return a[0] * first + b[0] * second, a[1] * first + b[1] * second, a[2] * first + b[2] * second

    def link_forces(self, q: list[float], v: list[float]) -> list[float]:
        """Force of springs and dampers on each body, (2N) interleaved x, y, from positions and velocities likewise."""
        force = [0.0] * (2 * self.count)
        for i, ((kx, ky), (cx, cy)) in enumerate(zip(self.links, self.dampers)):
            fx = kx * (q[2 * i + 2] - q[2 * i]) + cx * (v[2 * i + 2] - v[2 * i])
            fy = ky * (q[2 * i + 3] - q[2 * i + 1]) + cy * (v[2 * i + 3] - v[2 * i + 1])
            force[2 * i] += fx
            force[2 * i + 1] += fy
            force[2 * i + 2] -= fx
            force[2 * i + 3] -= fy
        return force

    def delta(self, x: float, y: float) -> float:
        """z1 - rho of (3.3)."""
        square = self.rho**2 - x * x - y * y
        if square <= 0.0:
            raise RefusalError("rim reached")
        return -math.sqrt(square)

    def stretch(self, x: float, y: float, ex: float, ey: float) -> float:
        """Slip speed (3.8) over horizontal speed for the horizontal direction e; 1 for the small equations."""
        if not self.exact:
            return 1.0
        return math.hypot(1.0, (x * ex + y * ey) / self.delta(x, y))

    def platform(
        self, t: float, x: float, y: float, fx: float, fy: float, slip: tuple[float, float], speed: float
    ) -> tuple[float, float, float, float]:
        """
        (ax, ay, az, N) of the platform. `slip` is mu w as its horizontal part; `speed` the horizontal speed along it
        (for the centripetal term), whose direction is that of `slip` if there is any friction.
        """
        m1, total = self.mass[0], self.total
        u, v, w = self.ground(t)
        bx, by, bz = fx / m1 - u, fy / m1 - v, -(GRAVITY + w)
        sx, sy = slip
        if not self.exact:
            normal = total / m1 * (GRAVITY + w)
            sx, sy = self.share(normal * m1) * sx, self.share(normal * m1) * sy
            ax = bx - normal * x / self.rho - (normal - x * u / self.rho) * sx + y * u / self.rho * sy
            ay = by - normal * y / self.rho - (normal - y * v / self.rho) * sy + x * v / self.rho * sx
            return ax, ay, 0.0, normal * m1
        z = self.delta(x, y)
        nx, ny, nz = -x / self.rho, -y / self.rho, -z / self.rho
        sz = -(x * sx + y * sy) / z

        def compliance(share: float) -> float:
            return (nx * (nx - share * sx) + ny * (ny - share * sy)) / m1 + nz * (nz - share * sz) / total

        if compliance(1.0) <= 0.0:
            raise RefusalError("painleve paradox")
        apart = speed / self.rho - (nx * bx + ny * by + nz * bz)
        normal = apart / compliance(1.0)
        if self.exponent:
            middle = apart / compliance(0.0)
            normal = brentq(lambda n: n * compliance(self.share(n)) - apart, 0.2 * middle, 5.0 * middle, rtol=1e-15)
        share = self.share(normal)
        dx, dy, dz = nx - share * sx, ny - share * sy, nz - share * sz
        return bx + normal * dx / m1, by + normal * dy / m1, bz + normal * dz / total, normal

    def speed_square(self, x: float, y: float, vx: float, vy: float) -> float:
        """|v|^2 of (3.8): with the vertical velocity for the exact equations."""
        if not self.exact:
            return vx * vx + vy * vy
        return vx * vx + vy * vy + ((x * vx + y * vy) / self.delta(x, y)) ** 2

    def share(self, normal: float) -> float:
        """Coefficient under a normal force over that under the reference load."""
        return (normal / self.reference) ** self.exponent if self.exponent else 1.0

    @property
    def coefficient_slope(self) -> float:
        """Of dry friction by the sliding speed, at rest, s/m."""
        return (self.fast - self.slow) * self.rate

    def coefficient(self, speed: float) -> float:
        """Of dry friction at a sliding speed."""
        if self.rate == 0.0:
            return self.mu
        return self.fast - (self.fast - self.slow) * math.exp(-self.rate * speed)

    def sliding(
        self, t: float, q: list[float], force: list[float], ex: float, ey: float, horizontal: float
    ) -> tuple[float, float, float, float]:
        """Set-valued dry law, sliding along the horizontal unit direction e at horizontal speed `horizontal`."""
        x, y = q[0], q[1]
        stretch = self.stretch(x, y, ex, ey)
        scale = self.coefficient(horizontal * stretch) / stretch
        return self.platform(t, x, y, force[0], force[1], (scale * ex, scale * ey), (horizontal * stretch) ** 2)

    def smooth(
        self, t: float, q: list[float], force: list[float], vx: float, vy: float, v_reg: float | None, inside: bool
    ) -> tuple[float, float, float, float]:
        """Laws that are smooth in each zone: lubricated, frictionless, or regularized in- or outside |v| = v_reg."""
        x, y = q[0], q[1]
        square = self.speed_square(x, y, vx, vy)
        if self.lubricated:
            factor = self.mu
        elif self.mu == 0.0:
            factor = 0.0
        else:
            assert v_reg is not None
            factor = self.coefficient(math.sqrt(square)) / (v_reg if inside else math.sqrt(square))
        return self.platform(t, x, y, force[0], force[1], (factor * vx, factor * vy), square)

    def smooth_rate(self, t: float, state: np.ndarray, v_reg: float | None) -> tuple[np.ndarray, float]:
        """Rate of positions and velocities, (4N) interleaved x, y, under such a law, and the normal force."""
        q, v = np.reshape(state, (2, -1)).tolist()
        force = self.link_forces(q, v)
        inside = v_reg is not None and self.speed_square(*q[:2], *v[:2]) < v_reg**2
        ax, ay, _, normal = self.smooth(t, q, force, v[0], v[1], v_reg, inside)
        return np.array([*v, ax, ay, *self.upper(t, force)]), normal

    def upper(self, t: float, force: list[float]) -> list[float]:
        """Accelerations of bodies 2..N relative to the plate (4.4)."""
        u, v, _ = self.ground(t)
        return [force[k] / self.mass[k // 2] - (v if k % 2 else u) for k in range(2, 2 * self.count)]

    def excess(self, t: float, q: list[float], force: list[float]) -> float:
        """Rest: required over available friction, minus 1; negative inside the cone. Consistent condition."""
        x, y = q[0], q[1]
        sx, sy = self.holding(t, x, y, force)
        u, v, w = self.ground(t)
        normal = self.total * (GRAVITY + w)
        if self.exact:
            m1, z = self.mass[0], self.delta(x, y)
            normal = -((m1 * u - force[0]) * x + (m1 * v - force[1]) * y + normal * z) / self.rho
        limit = self.mu * self.share(normal)
        if not self.exact:
            return math.hypot(sx, sy) / limit - 1.0
        return math.sqrt(self.speed_square(x, y, sx, sy)) / limit - 1.0

    def holding(self, t: float, x: float, y: float, force: list[float]) -> tuple[float, float]:
        """Horizontal part of the mu w that would give a = 0."""
        m1 = self.mass[0]
        u, v, w = self.ground(t)
        rx, ry, rz = m1 * u - force[0], m1 * v - force[1], self.total * (GRAVITY + w)  # reaction needed
        if self.exact:
            nx, ny, nz = -x / self.rho, -y / self.rho, -self.delta(x, y) / self.rho
            normal = rx * nx + ry * ny + rz * nz
            if normal <= 0.0:
                raise RefusalError("contact lost")
            return -(rx / normal - nx), -(ry / normal - ny)
        r = rz / m1
        if r <= 0.0:
            raise RefusalError("contact lost")
        dx, dy = -(rx / m1 + r * x / self.rho), -(ry / m1 + r * y / self.rho)  # F_3
        a, b = r - u * x / self.rho, -u * y / self.rho
        c, d = -v * x / self.rho, r - v * y / self.rho
        det = a * d - b * c
        return (d * dx - b * dy) / det, (a * dy - c * dx) / det

    def absolute_squares(self, t: float, force: list[float], platform: tuple[float, float, float]) -> list[float]:
        """|absolute acceleration|^2 of each body, with the vertical part all share."""
        u, v, w = self.ground(t)
        ax, ay, az = platform
        vertical = (az + w) ** 2
        squares = [(ax + u) ** 2 + (ay + v) ** 2 + vertical]
        for i in range(1, self.count):
            m = self.mass[i]
            squares.append((force[2 * i] / m) ** 2 + (force[2 * i + 1] / m) ** 2 + vertical)
        return squares
