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

def cell_at(p, variation):
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

def voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel):
    """Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice."""
    cell = cell_at(uv * cell_count, variation)
    return thickness_factor * cell.level * smoothstep(0.0, bevel, to_edge(cell))

def optical_depth(d, mean_free_path):
    """The thickness `d` in mean free paths, 0 or more."""
    path = max(mean_free_path, OPAQUE_DISTANCE)
    return clamp(d, 0.0, ENDLESS * path) / path

def beer_lambert(d, attenuation_distance):
    """Thickness to transmittance: the part of the light that absorption leaves."""
    return exp(-min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH))

def base_color(uv, tint, base_color_texture):
    """Colour and opacity from a texture and a tint."""
    texel = tint * texture(base_color_texture, uv)
    albedo = swizzle(texel, "xyz")
    alpha = texel[3]
    return albedo, alpha

def pbr_constants(metalness, surface_roughness):
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

def voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit):
    """The normal of the Voronoi cells, so that reflected light agrees with transmitted light."""
    cell = cell_at(uv * cell_count, variation)
    x = clamp(to_edge(cell) / bevel, 0.0, 1.0)
    # the derivative of the smoothstep
    steepness = cell.level * 6.0 * x * (1.0 - x) / bevel
    slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell)
    normal = blend_normals(normal, normal_of_slope(slope))
    return normal

def ice_mask(uv, through, cover, cover_texture):
    """Only the bare ice transmits light."""
    covered = cover * texture(cover_texture, uv)[0]
    through = clamp(through * smoothstep(0.0, 0.1, 1.0 - covered), 0.0, 1.0)
    return through

def layer(uv, speed, time, packed_texture):
    """One moving layer; the offset stays below 1, so that precision does not decrease with time."""
    return texture(packed_texture, uv + fract(speed * time))

def packed_scroll(uv, time, emission, packed_texture, red_speed, green_speed, blue_speed, vein_color,
    spark_color):
    """Moving light below the surface, from the channels of one texture, each of which scrolls separately."""
    veins = layer(uv, red_speed, time, packed_texture)[0] * layer(uv, green_speed, time, packed_texture)[1]
    sparks = layer(uv, blue_speed, time, packed_texture)[2]
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0)
    return emission

def left_at(uv, edge, erosion, erosion_texture):
    """The part of the surface that remains at `uv`: 1 = all, 0 = none."""
    # the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    threshold = mix(-edge, 1.0, erosion)
    return clamp((texture(erosion_texture, uv)[0] - threshold) / edge, 0.0, 1.0)

def alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture, edge_height):
    """Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge."""
    e = vec(texel_size, 0.0)
    across = left_at(uv + e, edge, erosion, erosion_texture) - left_at(uv - e, edge, erosion, erosion_texture)
    up = left_at(uv + swizzle(e, "yx"), edge, erosion, erosion_texture) - left_at(uv - swizzle(e, "yx"), edge,
        erosion, erosion_texture)
    slope = edge_height * uv_per_unit * vec(across, up) / (2.0 * texel_size)
    normal = blend_normals(normal, normal_of_slope(slope))
    alpha = alpha * left_at(uv, edge, erosion, erosion_texture)
    return alpha, normal

def glow(lobe, through, subsurface_color, attenuation, scale, ambient):
    """The transmitted light for a lobe value of 0..1 and a transmittance."""
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through)

def lobe_normalized(V, N, L, through, distortion, subsurface_color, attenuation, scale, ambient, power):
    """The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected."""
    bent = safe_normalize_vec3(L + N * distortion)
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation, scale,
        ambient)

def lobe_surroundings(mean_lobe, through, irradiance_behind, subsurface_color, attenuation, scale, ambient):
    """The light of the surroundings that comes through, for the mean of a lobe over the directions behind
    the body."""
    # the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through, subsurface_color, attenuation, scale, ambient) * irradiance_behind

def lobe_normalized_surroundings(through, irradiance_behind, subsurface_color, attenuation, scale, ambient,
    power):
    """The light of the surroundings that comes through."""
    return lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind, subsurface_color, attenuation,
        scale, ambient)

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

def evaluate_surface(uv, time, irradiance_behind, variation, cell_count, thickness_factor, bevel,
    attenuation_distance, tint, base_color_texture, metalness, surface_roughness, relief, uv_per_unit, cover,
    cover_texture, packed_texture, red_speed, green_speed, blue_speed, vein_color, spark_color, texel_size,
    edge, erosion, erosion_texture, edge_height, subsurface_color, attenuation, scale, ambient, power):
    """The values of the surface that do not depend on a light."""
    thickness = voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel)
    transmittance = beer_lambert(thickness, attenuation_distance)
    albedo, alpha = base_color(uv, tint, base_color_texture)
    metallic, roughness = pbr_constants(metalness, surface_roughness)
    normal = vec(0.0, 0.0, 1.0)
    normal = voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit)
    transmittance = ice_mask(uv, transmittance, cover, cover_texture)
    emission = splat(3, 0.0)
    emission = packed_scroll(uv, time, emission, packed_texture, red_speed, green_speed, blue_speed,
        vein_color, spark_color)
    alpha, normal = alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        edge_height)
    emission = emission + lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color,
        attenuation, scale, ambient, power)
    return Record(albedo=albedo, alpha=alpha, normal=normal, metallic=metallic, roughness=roughness,
        emission=emission, transmittance=transmittance)

def evaluate_translucency(surface, V, N, L, distortion, subsurface_color, attenuation, scale, ambient, power):
    """The transmitted light of one light, as a factor on its colour."""
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation, scale,
        ambient, power)

def evaluate_lighting(surface, N, V, L, light_color):
    """The reflected light of one light."""
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color)
