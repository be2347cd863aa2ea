"""Bsdfs and textures of the Mitsuba 3 dialect, with the constants of real stuff."""

from .xml import Element, boolean, number, rgb, string

# Refractive index and extinction of metals, averaged over the red, green and blue of linear sRGB.
METALS = {
    "silver": ((0.155, 0.117, 0.138), (4.832, 3.123, 2.149)),
    "gold": ((0.143, 0.375, 1.442), (3.983, 2.386, 1.603)),
    "copper": ((0.200, 0.924, 1.102), (3.913, 2.453, 2.142)),
    "chromium": ((4.370, 2.917, 1.655), (5.206, 4.231, 3.755)),
    "aluminium": ((1.657, 0.880, 0.521), (9.224, 6.270, 4.837)),
}


def bitmap(name, path, raw=False):
    """A picture as a texture; raw: numbers (bumps, opacity) and not sRGB colours."""
    parts = [string("filename", path)]
    if raw:
        parts.append(boolean("raw", True))
    return Element("texture", *parts, type="bitmap", name=name)


def checkerboard(name, colour0, colour1, repeats=1.0):
    """Squares of half a repeat; `repeats` of them in a unit of uv."""
    scaling = Element("transform", Element("scale", x=float(repeats), y=float(repeats)), name="to_uv")
    return Element("texture", rgb("color0", colour0), rgb("color1", colour1), scaling, type="checkerboard", name=name)


def _coloured(name, colour):
    return colour if isinstance(colour, Element) else rgb(name, colour)


def two_sided(bsdf):
    return Element("bsdf", bsdf, type="twosided")


def diffuse(colour):
    """colour: (r, g, b), or a texture named reflectance."""
    return Element("bsdf", _coloured("reflectance", colour), type="diffuse")


def plastic(colour):
    """A smooth coat of index 1.5 over a diffuse base; colour: (r, g, b), or a texture named diffuse_reflectance."""
    return Element("bsdf", number("int_ior", 1.5), boolean("nonlinear", True),
                   _coloured("diffuse_reflectance", colour), type="plastic")


def rough_plastic(colour, alpha):
    """A coat of GGX roughness alpha and index 1.5 over a diffuse base; colour as for `plastic`."""
    return Element("bsdf", string("distribution", "ggx"), number("alpha", alpha), number("int_ior", 1.5),
                   boolean("nonlinear", True), _coloured("diffuse_reflectance", colour), type="roughplastic")


def mirror():
    return Element("bsdf", string("material", "none"), type="conductor")


def rough_metal(name, alpha, tint=(1.0, 1.0, 1.0)):
    """A metal of METALS with GGX roughness alpha; tint multiplies what it reflects."""
    eta, k = METALS[name]
    return Element("bsdf", string("distribution", "ggx"), number("alpha", alpha), rgb("eta", eta), rgb("k", k),
                   rgb("specular_reflectance", tint), type="roughconductor")


def glass():
    return Element("bsdf", number("int_ior", 1.5), number("ext_ior", 1.0), type="dielectric")


def frosted_glass(alpha):
    return Element("bsdf", string("distribution", "ggx"), number("alpha", alpha), number("int_ior", 1.5),
                   number("ext_ior", 1.0), type="roughdielectric")


def pane():
    """A sheet of glass given by one surface."""
    return Element("bsdf", number("int_ior", 1.5), number("ext_ior", 1.0), type="thindielectric")


def mask(opacity, bsdf):
    """opacity: a texture named opacity; 0 lets everything through."""
    return Element("bsdf", opacity, bsdf, type="mask")


def bumpy(height, bsdf, scale):
    """height: a texture; `scale` times its value is the displacement in metres."""
    return Element("bsdf", height, number("scale", scale), bsdf, type="bumpmap")
