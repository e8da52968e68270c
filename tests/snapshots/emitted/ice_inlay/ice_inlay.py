# Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
# through around them.
# Made by sssgen for NumPy (vectorised; the oracle). Change the material and emit it again rather than this file.

from sssgen.targets.numpy_runtime import *  # noqa: F403

# Surface: Record(albedo, metallic, roughness, transmittance)

FLAT_FRAME = 0.01
OPAQUE_DISTANCE = 1e-06
ENDLESS = 10000.0
OPAQUE_DEPTH = 80.0

ior = 1.31  # Refractive index of the body.
depth = 0.04  # How far the image lies below the surface.
uv_per_unit = vec(1.0, 1.0)  # How far the texture coordinates move for one world unit along T and along B.
thickness_factor = 0.15  # The thickness that white means.
attenuation_distance = 0.08  # The length after which 1/e (37 %) of the light is left; 0 = opaque.
tint = vec(1.0, 1.0, 1.0, 1.0)  # Multiplies the texture.
metalness = 0.0  # 0 = not a metal, 1 = metal.
surface_roughness = 0.1  # 0 = a mirror, 1 = chalk.
distortion = 0.1  # How much the normal bends the light on its way through: 0 ignores the shape.
subsurface_color = vec(0.6, 0.88, 1.0)  # Colour of the light that has passed through.
scale = 2.5  # Strength of the glow towards the light.
ambient = 0.08  # Glow that is there from every side.
power = 8.0  # How tight the glow is around the light: the larger, the smaller the spot.

thickness_texture = Texture([[[0.0, 0.0, 0.0, 1.0]]])
base_color_texture = Texture([[[1.0, 1.0, 1.0, 1.0]]])

def valid_texel(x):
    """A texel within its range; 0 in place of NaN."""
    return select(isnan(x), 0.0, clamp(x, 0.0, 1.0))

def safe_normalize(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * inversesqrt(max(dot(x, x), 1.0000000031710769e-30))

def tangent_from_world(v, T, B, N):
    """The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N))."""
    volume = dot(T, cross(B, N))
    along = vec(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B), dot(v, cross(T, B)))
    return select(abs(volume) < FLAT_FRAME, vec(0.0, 0.0, dot(v, N)), along / volume)

def slide(uv, ray, T, B, N):
    """The texture coordinates where `ray`, going in, meets the inner layer."""
    r = tangent_from_world(ray, T, B, N)
    # to the surface itself, which a sheared frame does not lie in
    cosine = -dot(ray, N)
    # 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
    x = clamp(cosine / 0.2, 0.0, 1.0)
    reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2)
    return uv + depth * reciprocal * uv_per_unit * swizzle(r, "xy")

def parallax_refracted(uv, V, T, B, N):
    """Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice."""
    facing = faceforward(N, -V, N)
    # past the critical angle refract() gives 0, which slides nothing
    ray = refract(-V, facing, divide(1.0, ior))
    return slide(uv, ray, T, B, facing)

def thickness_map(uv):
    """Thickness from a baked map, bright where the body is thick."""
    return thickness_factor * valid_texel(texture(thickness_texture, uv)[0])

def optical_depth(d, mean_free_path):
    """`d` in mean free paths, 0 or more."""
    path = max(mean_free_path, OPAQUE_DISTANCE)
    return clamp(d, 0.0, ENDLESS * path) / path

def beer_lambert(d):
    """Thickness to transmittance: what absorption leaves of the light."""
    return exp(-min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH))

def base_color(uv):
    """Colour and opacity from a texture and a tint."""
    texel = tint * texture(base_color_texture, uv)
    albedo = swizzle(texel, "xyz")
    alpha = texel[3]
    return albedo, alpha

def pbr_constants():
    """The same metalness and roughness everywhere."""
    metallic = metalness
    roughness = surface_roughness
    return metallic, roughness

def glow(lobe, through):
    """The light that comes through where `lobe` (0..1) points at the eye."""
    return subsurface_color * ((lobe * scale + ambient) * through)

def lobe_gdc2011(V, N, L, through):
    """The back-light lobe of GDC 2011: the eye looks into light that comes through, bent by the normal."""
    bent = L + N * distortion
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through)

def standard(N, V, L, albedo, metallic, roughness, light_color):
    """The standard light of plain targets: Lambert and GGX with metallic and roughness, for one light."""
    H = safe_normalize(V + L)
    NoL = max(dot(N, L), 0.0)
    NoV = max(dot(N, V), 0.0001)
    NoH = clamp(dot(N, H), 0.0, 1.0)
    a = max(roughness, 0.045) * max(roughness, 0.045)
    # (a^2 - 1) dot(N, H)^2 + 1, but exact where N and H nearly meet and a mirror has its peak; never below a^2
    across = cross(N, H)
    spread = select(NoH > 0.0, max(dot(across, across) + NoH * NoH * (a * a), a * a), 1.0)
    # D times pi
    facets = a * a / (spread * spread)
    # masking and shadowing, over 4 dot(N, L) dot(N, V)
    visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a)
    # nothing reflects more than all
    F0 = mix(splat(3, 0.04), min(albedo, 1.0), metallic)
    F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0)
    diffuse = albedo * (1.0 - metallic) * (1.0 - F)
    return (diffuse + facets * visible * F) * NoL * light_color

def evaluate_surface(uv, V, T, B, N):
    """Everything about the surface that does not depend on a light."""
    uv = parallax_refracted(uv, V, T, B, N)
    thickness = thickness_map(uv)
    transmittance = beer_lambert(thickness)
    albedo, alpha = base_color(uv)
    metallic, roughness = pbr_constants()
    return Record(albedo=albedo, metallic=metallic, roughness=roughness, transmittance=transmittance)

def evaluate_translucency(surface, V, N, L):
    """What one light adds from behind, as a factor on its colour."""
    return lobe_gdc2011(V, N, L, surface.transmittance)

def evaluate_lighting(surface, N, V, L, light_color):
    """What one light adds from the front."""
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color)
