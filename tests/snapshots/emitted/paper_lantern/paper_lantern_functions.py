# Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
# dark.
# Made by sssgen for NumPy (vectorised; the oracle). Change the material and emit it again rather than this file.

from sssgen.targets.numpy_runtime import *  # noqa: F403

# Surface: Record(albedo, normal, metallic, roughness, transmittance)

def valid_texel(x):
    """A texel within its range; 0 in place of NaN."""
    return select(isnan(x), 0.0, clamp(x, 0.0, 1.0))

def safe_normalize(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * inversesqrt(max(dot(x, x), 1.0000000031710769e-30))

def thickness_map(uv, thickness_texture):
    """Thickness from a baked map, bright where the body is thick."""
    return valid_texel(texture(thickness_texture, uv)[0])

def thinness_from_thickness(d):
    """Thickness to thinness, in a straight line."""
    return clamp(1.0 - d, 0.0, 1.0)

def base_color(uv, tint, base_color_texture):
    """Colour and opacity from a texture and a tint."""
    texel = tint * texture(base_color_texture, uv)
    albedo = swizzle(texel, "xyz")
    alpha = texel[3]
    return albedo, alpha

def blend_normals(base, detail):
    """Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add."""
    return safe_normalize(vec(swizzle(base, "xy") + swizzle(detail, "xy"), base[2] * detail[2]))

def normal_map(uv, normal, normal_texture, normal_scale):
    """Detail in the normal, from a texture."""
    texel = unpackNormal(texture(normal_texture, uv))
    normal = blend_normals(normal, vec(swizzle(texel, "xy") * normal_scale, texel[2]))
    return normal

def pbr_constants(metalness, surface_roughness):
    """The same metalness and roughness everywhere."""
    metallic = metalness
    roughness = surface_roughness
    return metallic, roughness

def glow(lobe, through, subsurface_color, scale):
    """The light that comes through where `lobe` (0..1) points at the eye."""
    return subsurface_color * (lobe * scale * through)

def lobe_normalized(V, N, L, through, distortion, subsurface_color, scale, power):
    """The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected."""
    bent = safe_normalize(L + N * distortion)
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, scale)

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

def evaluate_surface(uv, thickness_texture, tint, base_color_texture, normal_texture, normal_scale, metalness,
    surface_roughness):
    """Everything about the surface that does not depend on a light."""
    thickness = thickness_map(uv, thickness_texture)
    thinness = thinness_from_thickness(thickness)
    transmittance = thinness
    albedo, alpha = base_color(uv, tint, base_color_texture)
    normal = vec(0.0, 0.0, 1.0)
    normal = normal_map(uv, normal, normal_texture, normal_scale)
    metallic, roughness = pbr_constants(metalness, surface_roughness)
    return Record(albedo=albedo, normal=normal, metallic=metallic, roughness=roughness,
        transmittance=transmittance)

def evaluate_translucency(surface, V, N, L, distortion, subsurface_color, scale, power):
    """What one light adds from behind, as a factor on its colour."""
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, scale, power)

def evaluate_lighting(surface, N, V, L, light_color):
    """What one light adds from the front."""
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color)
