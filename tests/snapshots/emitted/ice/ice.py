# Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
# that melt into it.
# Made by sssgen for NumPy (vectorised; the oracle). Change the material and emit it again rather than this file.

from sssgen.targets.numpy_runtime import *  # noqa: F403

# Cell: Record(nearest, second, level)

# Surface: Record(albedo, alpha, normal, metallic, roughness, emission, transmittance)

JITTER = 0.6
OPAQUE_DISTANCE = 1e-06
ENDLESS = 10000.0
OPAQUE_DEPTH = 80.0
MAX_LIGHTS = 4

variation = 0.6  # How much the levels of the cells differ: 0 = all are equal
cell_count = 10.0  # Number of cells along one unit of texture coordinate
thickness_factor = 0.3  # Thickness of a cell of level 1
bevel = 0.35  # Width of the slope next to an edge, in cells
attenuation_distance = 0.25  # The length after which 1/e (37 %) of the light remains; 0 = opaque
tint = vec(0.75, 0.9, 1.0, 1.0)  # Multiplies the texture
metalness = 0.0  # 0 = not a metal, 1 = metal
surface_roughness = 0.12  # 0 = smooth as a mirror, 1 = rough as chalk
relief = 0.01  # Height of the thickest cells above their edges
uv_per_unit = vec(1.0, 1.0)  # Change of the texture coordinates per world unit along T and along B
cover = 1.0  # Multiplies the texture
red_speed = vec(0.02, 0.0)  # Velocity of the red layer
green_speed = vec(-0.01, 0.015)  # Velocity of the green layer
blue_speed = vec(0.0, -0.025)  # Velocity of the blue layer
vein_color = vec(0.3, 0.8, 1.0)  # Colour of the light in the red and green layers, where both are bright
spark_color = vec(0.6, 0.9, 1.0)  # Colour of the light in the blue layer
texel_size = 0.002  # The length, in texture coordinates, over which slopes are measured: about one texel
edge = 0.15  # Width of the soft edge, in the texture's values
erosion = 0.2  # How much is eroded: 0 = nothing, 1 = everything
edge_height = 0.02  # Height of the step in the surface at the edge
distortion = 0.2  # How far the normal bends the light's direction inside the body: 0 ignores the shape
subsurface_color = vec(0.55, 0.85, 1.0)  # Colour of the transmitted light
attenuation = 0.8  # Factor on the whole result
scale = 2.0  # Strength of the glow towards the light
ambient = 0.12  # Glow that does not depend on the direction
power = 6.0  # How narrow the glow around the light is: the larger, the smaller the spot

base_color_texture = Texture([[[1.0, 1.0, 1.0, 1.0]]])
cover_texture = Texture([[[0.0, 0.0, 0.0, 1.0]]])
packed_texture = Texture([[[0.0, 0.0, 0.0, 1.0]]])
erosion_texture = Texture([[[1.0, 1.0, 1.0, 1.0]]])

def safe_normalize_vec2(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * select(dot(x, x) > 1.0000000031710769e-30, inversesqrt(dot(x, x)), 0.0)

def safe_normalize_vec3(x):
    """The direction of `x`; of a zero vector, 0."""
    return x * select(dot(x, x) > 1.0000000031710769e-30, inversesqrt(dot(x, x)), 0.0)

def hash_bits(x):
    """Scrambles the bits of `x`; 0 stays 0."""
    x = (x ^ (x >> 16)) * 2146121005
    x = (x ^ (x >> 15)) * 2221713035
    return x ^ (x >> 16)

def hash_unit(x):
    """A number in [0, 1) from 24 bits of the hash of `x`."""
    return to_float(hash_bits(x) >> 8) * 5.960464477539063e-08

def cell_at(p):
    """The cell at `p`."""
    nearest = splat(2, 4.0)
    second = splat(2, 4.0)
    # their squared lengths
    first_square = 32.0
    second_square = 32.0
    owner = to_uint(0)
    # relative to the cell's corner, so that precision does not depend on the distance from the origin
    home = floor(p)
    within = p - home
    for j in range(-1, 2):
        for i in range(-1, 2):
            offset = vec(to_float(i), to_float(j))
            corner = home + offset
            seed = hash_bits(to_uint(to_int(corner[0])) + hash_bits(to_uint(to_int(corner[1])) + 1))
            shift = vec(hash_unit(seed + 1), hash_unit(seed + 2)) - 0.5
            to_site = offset + 0.5 + JITTER * shift - within
            square = dot(to_site, to_site)
            mask = square < first_square
            second = select(mask, nearest, second)
            second_square = select(mask, first_square, second_square)
            nearest = select(mask, to_site, nearest)
            first_square = select(mask, square, first_square)
            owner = select(mask, seed, owner)
            mask_2 = not_(mask) & (square < second_square)
            second = select(mask_2, to_site, second)
            second_square = select(mask_2, square, second_square)
    level = 1.0 - variation * hash_unit(owner + 3)
    return Record(nearest=nearest, second=second, level=level)

def to_edge(cell):
    """How much farther the second nearest site is than the nearest one: 0 on the edges."""
    return length(cell.second) - length(cell.nearest)

def voronoi_thickness(uv):
    """Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice."""
    cell = cell_at(uv * cell_count)
    return thickness_factor * cell.level * smoothstep(0.0, bevel, to_edge(cell))

def optical_depth(d, mean_free_path):
    """The thickness `d` in mean free paths, 0 or more."""
    path = max(mean_free_path, OPAQUE_DISTANCE)
    return clamp(d, 0.0, ENDLESS * path) / path

def beer_lambert(d):
    """Thickness to transmittance: the part of the light that absorption leaves."""
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

def from_edge(cell):
    """The gradient of to_edge."""
    # the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize_vec2(cell.nearest) - normalize(cell.second)

def blend_normals(base, detail):
    """Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes."""
    return safe_normalize_vec3(vec(swizzle(base, "xy") + swizzle(detail, "xy"), base[2] * detail[2]))

def normal_of_slope(slope):
    """The normal of a height field; `slope` is the increase in height per unit of length along T and B."""
    return normalize(vec(-slope, 1.0))

def voronoi_normal(uv, normal):
    """The normal of the Voronoi cells, so that reflected light agrees with transmitted light."""
    cell = cell_at(uv * cell_count)
    x = clamp(to_edge(cell) / bevel, 0.0, 1.0)
    # the derivative of the smoothstep
    steepness = cell.level * 6.0 * x * (1.0 - x) / bevel
    slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell)
    normal = blend_normals(normal, normal_of_slope(slope))
    return normal

def ice_mask(uv, through):
    """Only the bare ice transmits light."""
    covered = cover * texture(cover_texture, uv)[0]
    through = through * smoothstep(0.0, 0.1, 1.0 - covered)
    return through

def layer(uv, speed, time):
    """One moving layer; the offset stays below 1, so that precision does not decrease with time."""
    return texture(packed_texture, uv + fract(speed * time))

def packed_scroll(uv, time, emission):
    """Moving light below the surface, from the channels of one texture, each of which scrolls separately."""
    veins = layer(uv, red_speed, time)[0] * layer(uv, green_speed, time)[1]
    sparks = layer(uv, blue_speed, time)[2]
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0)
    return emission

def left_at(uv):
    """The part of the surface that remains at `uv`: 1 = all, 0 = none."""
    # the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    threshold = mix(-edge, 1.0, erosion)
    return clamp((texture(erosion_texture, uv)[0] - threshold) / edge, 0.0, 1.0)

def alpha_erosion(uv, alpha, normal):
    """Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge."""
    e = vec(texel_size, 0.0)
    across = left_at(uv + e) - left_at(uv - e)
    up = left_at(uv + swizzle(e, "yx")) - left_at(uv - swizzle(e, "yx"))
    slope = edge_height * uv_per_unit * vec(across, up) / (2.0 * texel_size)
    normal = blend_normals(normal, normal_of_slope(slope))
    alpha = alpha * left_at(uv)
    return alpha, normal

def glow(lobe, through):
    """The transmitted light for a lobe value of 0..1 and a transmittance."""
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through)

def lobe_normalized(V, N, L, through):
    """The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected."""
    bent = safe_normalize_vec3(L + N * distortion)
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through)

def lobe_surroundings(mean_lobe, through, irradiance_behind):
    """The light of the surroundings that comes through, for the mean of a lobe over the directions behind
    the body."""
    # the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through) * irradiance_behind

def lobe_normalized_surroundings(through, irradiance_behind):
    """The light of the surroundings that comes through."""
    return lobe_surroundings(divide(1.0, power + 1.0), through, irradiance_behind)

def standard(N, V, L, albedo, metallic, roughness, light_color):
    """The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for
    one light."""
    H = safe_normalize_vec3(V + L)
    NoL = max(dot(N, L), 0.0)
    NoV = max(dot(N, V), 0.0001)
    NoH = clamp(dot(N, H), 0.0, 1.0)
    a = max(roughness, 0.045) * max(roughness, 0.045)
    # (a^2 - 1) dot(N, H)^2 + 1, but accurate at the peak, where N and H nearly coincide; never below a^2
    across = cross(N, H)
    spread = select(NoH > 0.0, max(dot(across, across) + NoH * NoH * (a * a), a * a), 1.0)
    # D times pi
    facets = a * a / (spread * spread)
    # masking and shadowing, divided by 4 dot(N, L) dot(N, V)
    visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a)
    # a surface reflects at most all light
    F0 = mix(splat(3, 0.04), min(albedo, 1.0), metallic)
    # what reflects less than 2 % from the front is no mirror from the side
    F90 = min(max(dot(F0, splat(3, 17.0)), metallic), 1.0)
    F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0)
    diffuse = albedo * (1.0 - metallic) * (1.0 - F)
    reflected = (diffuse + facets * visible * F) * NoL
    return reflected * light_color

def evaluate_surface(uv, time, irradiance_behind):
    """The values of the surface that do not depend on a light."""
    thickness = voronoi_thickness(uv)
    transmittance = beer_lambert(thickness)
    albedo, alpha = base_color(uv)
    metallic, roughness = pbr_constants()
    normal = vec(0.0, 0.0, 1.0)
    normal = voronoi_normal(uv, normal)
    transmittance = ice_mask(uv, transmittance)
    emission = splat(3, 0.0)
    emission = packed_scroll(uv, time, emission)
    alpha, normal = alpha_erosion(uv, alpha, normal)
    emission = emission + lobe_normalized_surroundings(transmittance, irradiance_behind)
    return Record(albedo=albedo, alpha=alpha, normal=normal, metallic=metallic, roughness=roughness,
        emission=emission, transmittance=transmittance)

def evaluate_translucency(surface, V, N, L):
    """The transmitted light of one light, as a factor on its colour."""
    return lobe_normalized(V, N, L, surface.transmittance)

def evaluate_lighting(surface, N, V, L, light_color):
    """The reflected light of one light."""
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color)

def shade_fragment(P, camera_position_, vertex_normal, vertex_tangent, ambient_color_, light_count_,
    light_positions_, light_colors_, uv, time):
    """The light of one fragment, in a target without an engine."""
    discarded = False
    V = safe_normalize_vec3(camera_position_ - P)
    N = safe_normalize_vec3(vertex_normal)
    T = safe_normalize_vec3(swizzle(vertex_tangent, "xyz"))
    B = cross(N, T) * vertex_tangent[3]
    surface = evaluate_surface(uv, time, ambient_color_)
    across = T * surface.normal[0] + B * surface.normal[1]
    N = safe_normalize_vec3(across + N * surface.normal[2])
    color = ambient_color_ * surface.albedo + surface.emission
    i = 0
    running = i < min(light_count_, MAX_LIGHTS)
    while any(running):
        near = index(light_positions_, i)[3]
        to_light = swizzle(index(light_positions_, i), "xyz") - P * near
        distance_squared = max(dot(to_light, to_light), 0.0001)
        L = to_light * inversesqrt(distance_squared)
        light_color = swizzle(index(light_colors_, i), "xyz") * mix(1.0, 1.0 / distance_squared, near)
        color = select(running, color + evaluate_lighting(surface, N, V, L, light_color), color)
        color = select(running, color + evaluate_translucency(surface, V, N, L) * light_color, color)
        i = i + 1
        running = running & (i < min(light_count_, MAX_LIGHTS))
    mask = surface.alpha < 0.5
    discarded = discarded | mask
    return select(mask, splat(4, 0.0), vec(color, surface.alpha)), discarded
