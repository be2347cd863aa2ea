"""Daylight: the sky of Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (SIGGRAPH 1999)."""

import math

from .geometry import dot

# Coefficients A to E of Perez' formula for luminance Y and chromaticities x, y: (slope, offset) in turbidity.
_PEREZ = {
    "Y": ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
    "x": ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
    "y": ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)),
}
# Chromaticity of the zenith: rows for turbidity squared, turbidity and one; columns for the sun's angle cubed to one.
_ZENITH = {
    "x": ((0.00166, -0.00375, 0.00209, 0.0), (-0.02903, 0.06377, -0.03202, 0.00394),
          (0.11693, -0.21196, 0.06052, 0.25886)),
    "y": ((0.00275, -0.00610, 0.00317, 0.0), (-0.04214, 0.08970, -0.04153, 0.00516),
          (0.15346, -0.26756, 0.06670, 0.26688)),
}


def sky_radiance(direction, sun, turbidity):
    """Linear RGB of the sky in kcd/m^2. `direction` (above the horizon) and `sun` are unit vectors."""
    zenith_angle = math.acos(min(1.0, max(0.01, direction[1])))
    sun_angle = math.acos(sun[1])
    gamma = math.acos(min(1.0, max(-1.0, dot(direction, sun))))

    def relative(kind):
        a, b, c, d, e = (slope * turbidity + offset for slope, offset in _PEREZ[kind])

        def perez(theta, angle):
            return (1 + a * math.exp(b / math.cos(theta))) * (1 + c * math.exp(d * angle) + e * math.cos(angle) ** 2)
        return perez(zenith_angle, gamma) / perez(0.0, sun_angle)

    chi = (4 / 9 - turbidity / 120) * (math.pi - 2 * sun_angle)
    luminance = ((4.0453 * turbidity - 4.9710) * math.tan(chi) - 0.2155 * turbidity + 2.4192) * relative("Y")
    x, y = (_zenith_chromaticity(kind, sun_angle, turbidity) * relative(kind) for kind in ("x", "y"))
    return _linear_rgb(x, y, luminance)


def _zenith_chromaticity(kind, sun_angle, turbidity):
    powers = (sun_angle**3, sun_angle**2, sun_angle, 1.0)
    rows = [sum(c * p for c, p in zip(row, powers)) for row in _ZENITH[kind]]
    return rows[0] * turbidity**2 + rows[1] * turbidity + rows[2]


def _linear_rgb(x, y, luminance):
    """Linear sRGB (D65) of a colour given by chromaticity and luminance; what no display can show becomes 0."""
    cx, cz = luminance * x / y, luminance * (1 - x - y) / y
    return (max(0.0, 3.2406 * cx - 1.5372 * luminance - 0.4986 * cz),
            max(0.0, -0.9689 * cx + 1.8758 * luminance + 0.0415 * cz),
            max(0.0, 0.0557 * cx - 0.2040 * luminance + 1.0570 * cz))


def environment(sun, turbidity, ground, width=192):
    """Rows of a latitude-longitude picture of sky and ground, for Mitsuba's `envmap`.

    Column u, row v (from the top) show the direction with u = atan2(x, -z) / 2 pi and v = acos(y) / pi. The sun's disk
    is left out: a directional emitter stands for it. ground: the radiance of everything below the horizon.
    """
    height = width // 2
    rows = []
    for j in range(height):
        theta = math.pi * (j + 0.5) / height
        row = []
        for i in range(width):
            phi = 2 * math.pi * (i + 0.5) / width
            direction = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
            row.append(sky_radiance(direction, sun, turbidity) if direction[1] > 0 else ground)
        rows.append(row)
    return rows
