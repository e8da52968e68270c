# Wax mouse: A candle in the shape of a mouse: the ears glow, the body stays deep.
# Made by sssgen for NumPy (vectorised; the oracle). Change the material and emit it again rather than this file.

from sssgen.targets.numpy_runtime import *  # noqa: F403

# Surface: Record(albedo, metallic, roughness)

NEGLIGIBLE = 1e-06
DARKEST = 0.0001
OPAQUE_DISTANCE = 1e-06
ENDLESS = 10000.0
OPAQUE_DEPTH = 80.0

box_max = vec(-1.0, 2.35, 5.05)  # The box's largest corner.
box_min = vec(-4.0, 0.15, 3.15)  # The box's smallest corner.
distance_range = 1.0  # The distance that the texture's 1 stands for.
object_scale = 1.0  # World units in one unit of object space (uniform scale).
tint = vec(0.93, 0.86, 0.7, 1.0)  # Multiplies the texture.
metalness = 0.0  # 0 = not a metal, 1 = metal.
surface_roughness = 0.4  # 0 = a mirror, 1 = chalk.
attenuation_color = vec(0.95, 0.62, 0.3)  # The colour that white light has after attenuation_distance.
attenuation_distance = 0.35  # The length after which white light has attenuation_color; 0 = opaque.
weight = 0.6  # How much of the light goes in at all.

distance_map = Texture([[[[1.0, 1.0, 1.0, 1.0]]]])
base_color_texture = Texture([[[1.0, 1.0, 1.0, 1.0]]])

def safe_normalize(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * inversesqrt(max(dot(x, x), 1.0000000031710769e-30))

def box_size():
    """The box's size; a flat box is padded to a thousandth of its diagonal, about its centre."""
    return max(box_max - box_min, splat(3, 0.001 * distance(box_min, box_max)))

def from_box_center(p):
    """The way from the box's centre to `p`."""
    return p - 0.5 * (box_min + box_max)

def box_exit(p, direction):
    """How far it is from `p`, inside the box, along `direction` to the box's side."""
    exits = (0.5 * box_size() - from_box_center(p) * sign(direction)) / max(abs(direction),
        9.999999682655225e-21)
    # along a zero direction it would be endless
    return clamp(min(exits[0], min(exits[1], exits[2])), 0.0, length(box_size()))

def distance_texture(p):
    """The signed distance to a mesh, from a 3-D texture that was baked over a box in object space."""
    uvw = clamp(from_box_center(p) / max(box_size(), 9.999999682655225e-21) + 0.5, 0.0, 1.0)
    return (2.0 * textureLod(distance_map, uvw, 0.0)[0] - 1.0) * distance_range

def inside_part(a, b):
    """The part of a step that is inside the body, where the distance goes from `a` to `b` in a straight line."""
    inside = max(-a, 0.0) + max(-b, 0.0)
    whole = abs(a) + abs(b)
    return inside / max(whole, 9.999999682655225e-21)

def length_to_light(p, L):
    """The length inside the body from `p` to the box's side, along L."""
    h = box_exit(p, L) / 8.0
    inside = 0.0
    before = distance_texture(p)
    # it ends where the body is farther away than the box's side
    i = 1
    running = (i <= 8) & (before < h * to_float(9 - i))
    while any(running):
        after = distance_texture(p + L * (h * to_float(i)))
        inside = select(running, inside + inside_part(before, after), inside)
        before = select(running, after, before)
        i = i + 1
        running = running & ((i <= 8) & (before < h * to_float(9 - i)))
    return inside * h

def march_distance_texture(P_object, V_object, L_object):
    """Mean length, inside the body, of the light's ways to the eye: in along L, out along V."""
    length_of_view = box_exit(P_object, -V_object)
    seen = 0.0
    way = 0.0
    last = 0.0
    before = distance_texture(P_object)
    i = 1
    running = (i <= 8) & (before < length_of_view - last)
    while any(running):
        x = to_float(i) / 8.0
        t = length_of_view * x * x
        after = distance_texture(P_object - V_object * t)
        inside = (t - last) * inside_part(before, after)
        mask = running & (inside > 0.0)
        # the light scatters in the middle of what is inside
        middle = select(before < after, last + 0.5 * inside, t - 0.5 * inside)
        way = select(mask, way + inside
            * (seen + 0.5 * inside + length_to_light(P_object - V_object * middle, L_object)), way)
        seen = select(mask, seen + inside, seen)
        before = select(running, after, before)
        last = select(running, t, last)
        i = i + 1
        running = running & ((i <= 8) & (before < length_of_view - last))
    mean = divide(way, seen)
    return select(seen < NEGLIGIBLE, object_scale * length_to_light(P_object, L_object), object_scale * mean)

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

def optical_depth(d, mean_free_path):
    """`d` in mean free paths, 0 or more."""
    path = max(mean_free_path, OPAQUE_DISTANCE)
    return clamp(d, 0.0, ENDLESS * path) / path

def absorption_tint(d):
    """Light that comes through coloured by what the body absorbs: deeper colours where it is thicker."""
    sigma_d = -log(clamp(attenuation_color, DARKEST, 1.0)) * optical_depth(d, attenuation_distance)
    return weight * exp(-min(sigma_d, OPAQUE_DEPTH))

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

def evaluate_surface(uv):
    """Everything about the surface that does not depend on a light."""
    albedo, alpha = base_color(uv)
    metallic, roughness = pbr_constants()
    return Record(albedo=albedo, metallic=metallic, roughness=roughness)

def evaluate_translucency(surface, P_object, V_object, L_object):
    """What one light adds from behind, as a factor on its colour."""
    thickness = march_distance_texture(P_object, V_object, L_object)
    return absorption_tint(thickness)

def evaluate_lighting(surface, N, V, L, light_color):
    """What one light adds from the front."""
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color)
