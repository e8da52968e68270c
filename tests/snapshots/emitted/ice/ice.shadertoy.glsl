// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Shadertoy. Change the material and emit it again rather than this file.
// Paste it into the tab "Image" of a new shader.
// iChannel0 is base_color_texture (wrap: repeat). Colour of the surface (an sRGB texture), with its opacity in alpha.
// iChannel1 is cover_texture (wrap: repeat). Cover on the ice (snow, rock): black = bare ice, white = covered.
// iChannel2 is packed_texture (wrap: repeat). Three pictures in one texture: red, green and blue each hold a layer.
// iChannel3 is erosion_texture (wrap: repeat). Mask of the erosion: dark parts disappear first.
// Choose a picture for each channel, with the filter "mipmap" and VFlip.

// The camera, the lights and the picture behind: change them here.
const float CAMERA_DISTANCE = 4.0;
const float FIELD_OF_VIEW = 35.0;  // degrees, from the bottom to the top
const vec3 BACKGROUND_COLOR = vec3(0.02, 0.025, 0.035);
const int LIGHT_COUNT = 2;
const vec4 LIGHT_POSITIONS[2] = vec4[2](  // w = 1: where the light is; w = 0: the direction towards it
    vec4(-0.8, 0.5, -1.6, 0.0),
    vec4(2.0, 2.5, 3.0, 1.0)
);
const vec3 LIGHT_COLORS[2] = vec3[2](vec3(1.3, 1.2, 1.0), vec3(6.0));
const vec3 AMBIENT_COLOR = vec3(0.06, 0.07, 0.08);

// The linear colour of an sRGB texel, which Shadertoy does not decode.
vec4 linear_texel(vec4 texel) {
    vec3 bright = pow((max(texel.rgb, 0.04045) + 0.055) / 1.055, vec3(2.4));
    return vec4(mix(texel.rgb / 12.92, bright, step(0.04045, texel.rgb)), texel.a);
}

struct Cell {
    vec2 nearest;
    vec2 second;
    float level;
};

struct Surface {
    vec3 albedo;
    float alpha;
    vec3 normal;
    float metallic;
    float roughness;
    vec3 emission;
    float transmittance;
};

const float JITTER = 0.6;
const float OPAQUE_DISTANCE = 1.0e-6;
const float ENDLESS = 10000.0;
const float OPAQUE_DEPTH = 80.0;
const int MAX_LIGHTS = 4;

// How much the levels of the cells differ: 0 = all are equal. (0 to 1)
const float variation = 0.6;
// Number of cells along one unit of texture coordinate. (1 to 200)
const float cell_count = 10.0;
// Thickness of a cell of level 1. (0 to 10, m)
const float thickness_factor = 0.3;
// Width of the slope next to an edge, in cells. (0.05 to 1)
const float bevel = 0.35;
// The length after which 1/e (37 %) of the light remains; 0 = opaque. (0 to 10, m)
const float attenuation_distance = 0.25;
// Multiplies the texture.
const vec4 tint = vec4(0.75, 0.9, 1.0, 1.0);
// 0 = not a metal, 1 = metal. (0 to 1)
const float metalness = 0.0;
// 0 = smooth as a mirror, 1 = rough as chalk. (0 to 1)
const float surface_roughness = 0.12;
// Height of the thickest cells above their edges. (0 to 1, m)
const float relief = 0.01;
// Change of the texture coordinates per world unit along T and along B. (1/m)
const vec2 uv_per_unit = vec2(1.0, 1.0);
// Multiplies the texture. (0 to 1)
const float cover = 1.0;
// Velocity of the red layer. (1/s)
const vec2 red_speed = vec2(0.02, 0.0);
// Velocity of the green layer. (1/s)
const vec2 green_speed = vec2(-0.01, 0.015);
// Velocity of the blue layer. (1/s)
const vec2 blue_speed = vec2(0.0, -0.025);
// Colour of the light in the red and green layers, where both are bright.
const vec3 vein_color = vec3(0.3, 0.8, 1.0);
// Colour of the light in the blue layer.
const vec3 spark_color = vec3(0.6, 0.9, 1.0);
// The length, in texture coordinates, over which slopes are measured: about one texel. (0.0001 to 0.1)
const float texel_size = 0.002;
// Width of the soft edge, in the texture's values. (0.01 to 1)
const float edge = 0.15;
// How much is eroded: 0 = nothing, 1 = everything. (0 to 1)
const float erosion = 0.2;
// Height of the step in the surface at the edge. (0 to 1, m)
const float edge_height = 0.02;
// How far the normal bends the light's direction inside the body: 0 ignores the shape. (0 to 1)
const float distortion = 0.2;
// Colour of the transmitted light.
const vec3 subsurface_color = vec3(0.55, 0.85, 1.0);
// Factor on the whole result. (0 to 1)
const float attenuation = 0.8;
// Strength of the glow towards the light. (0 to 20)
const float scale = 2.0;
// Glow that does not depend on the direction. (0 to 1)
const float ambient = 0.12;
// How narrow the glow around the light is: the larger, the smaller the spot. (1 to 32)
const float power = 6.0;

#define base_color_texture iChannel0
#define cover_texture iChannel1
#define packed_texture iChannel2
#define erosion_texture iChannel3

// The direction of `x`; of a zero vector, 0.
vec2 safe_normalize(vec2 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// The direction of `x`; of a zero vector, 0.
vec3 safe_normalize(vec3 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// Scrambles the bits of `x`; 0 stays 0.
uint hash_bits(uint x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of `x`.
float hash_unit(uint x) {
    return float(hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at `p`.
Cell cell_at(vec2 p) {
    vec2 nearest = vec2(4.0);
    vec2 second = vec2(4.0);
    // their squared lengths
    float first_square = 32.0;
    float second_square = 32.0;
    uint owner = 0u;
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    vec2 home = floor(p);
    vec2 within = p - home;
    for (int j = -1; j <= 1; j++) {
        for (int i = -1; i <= 1; i++) {
            vec2 offset = vec2(float(i), float(j));
            vec2 corner = home + offset;
            uint seed = hash_bits(uint(int(corner.x)) + hash_bits(uint(int(corner.y)) + 1u));
            vec2 shift = vec2(hash_unit(seed + 1u), hash_unit(seed + 2u)) - 0.5;
            vec2 to_site = offset + 0.5 + JITTER * shift - within;
            float square = dot(to_site, to_site);
            if (square < first_square) {
                second = nearest;
                second_square = first_square;
                nearest = to_site;
                first_square = square;
                owner = seed;
            } else if (square < second_square) {
                second = to_site;
                second_square = square;
            }
        }
    }
    float level = 1.0 - variation * hash_unit(owner + 3u);
    return Cell(nearest, second, level);
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
float to_edge(Cell cell) {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
float voronoi_thickness(vec2 uv) {
    Cell cell = cell_at(uv * cell_count);
    return thickness_factor * cell.level * smoothstep(0.0, bevel, to_edge(cell));
}

// The thickness `d` in mean free paths, 0 or more.
float optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
float beer_lambert(float d) {
    return exp(-min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
void base_color(vec2 uv, out vec3 albedo, out float alpha) {
    vec4 texel = tint * linear_texel(texture(base_color_texture, uv));
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The gradient of to_edge.
vec2 from_edge(Cell cell) {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize(cell.nearest) - normalize(cell.second);
}

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
vec3 blend_normals(vec3 base, vec3 detail) {
    return safe_normalize(vec3(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
vec3 normal_of_slope(vec2 slope) {
    return normalize(vec3(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
void voronoi_normal(vec2 uv, inout vec3 normal) {
    Cell cell = cell_at(uv * cell_count);
    float x = clamp(to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    vec2 slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell);
    normal = blend_normals(normal, normal_of_slope(slope));
}

// Only the bare ice transmits light.
void ice_mask(vec2 uv, inout float through) {
    float covered = cover * texture(cover_texture, uv).r;
    through = through * smoothstep(0.0, 0.1, 1.0 - covered);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
vec4 layer(vec2 uv, vec2 speed, float time) {
    return texture(packed_texture, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void packed_scroll(vec2 uv, float time, inout vec3 emission) {
    float veins = layer(uv, red_speed, time).x * layer(uv, green_speed, time).y;
    float sparks = layer(uv, blue_speed, time).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0);
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
float left_at(vec2 uv) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = mix(-edge, 1.0, erosion);
    return clamp((texture(erosion_texture, uv).r - threshold) / edge, 0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void alpha_erosion(vec2 uv, inout float alpha, inout vec3 normal) {
    vec2 e = vec2(texel_size, 0.0);
    float across = left_at(uv + e) - left_at(uv - e);
    float up = left_at(uv + e.yx) - left_at(uv - e.yx);
    vec2 slope = edge_height * uv_per_unit * vec2(across, up) / (2.0 * texel_size);
    normal = blend_normals(normal, normal_of_slope(slope));
    alpha *= left_at(uv);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
vec3 glow(float lobe, float through) {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
vec3 lobe_normalized(vec3 V, vec3 N, vec3 L, float through) {
    vec3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
vec3 lobe_surroundings(float mean_lobe, float through, vec3 irradiance_behind) {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through) * irradiance_behind;
}

// The light of the surroundings that comes through.
vec3 lobe_normalized_surroundings(float through, vec3 irradiance_behind) {
    return lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
vec3 standard(vec3 N, vec3 V, vec3 L, vec3 albedo, float metallic, float roughness, vec3 light_color) {
    vec3 H = safe_normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 0.0001);
    float NoH = clamp(dot(N, H), 0.0, 1.0);
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but accurate at the peak, where N and H nearly coincide; never below a^2
    vec3 across = cross(N, H);
    float spread = NoH > 0.0 ? max(dot(across, across) + NoH * NoH * (a * a), a * a) : 1.0;
    // D times pi
    float facets = a * a / (spread * spread);
    // masking and shadowing, divided by 4 dot(N, L) dot(N, V)
    float visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // a surface reflects at most all light
    vec3 F0 = mix(vec3(0.04), min(albedo, 1.0), metallic);
    // what reflects less than 2 % from the front is no mirror from the side
    float F90 = min(max(dot(F0, vec3(17.0)), metallic), 1.0);
    vec3 F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    vec3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    vec3 reflected = (diffuse + facets * visible * F) * NoL;
    return reflected * light_color;
}

// The values of the surface that do not depend on a light.
Surface evaluate_surface(vec2 uv, float time, vec3 irradiance_behind) {
    float thickness = voronoi_thickness(uv);
    float transmittance = beer_lambert(thickness);
    vec3 albedo;
    float alpha;
    base_color(uv, albedo, alpha);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    voronoi_normal(uv, normal);
    ice_mask(uv, transmittance);
    vec3 emission = vec3(0.0);
    packed_scroll(uv, time, emission);
    alpha_erosion(uv, alpha, normal);
    emission += lobe_normalized_surroundings(transmittance, irradiance_behind);
    return Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
}

// The transmitted light of one light, as a factor on its colour.
vec3 evaluate_translucency(Surface surface, vec3 V, vec3 N, vec3 L) {
    return lobe_normalized(V, N, L, surface.transmittance);
}

// The reflected light of one light.
vec3 evaluate_lighting(Surface surface, vec3 N, vec3 V, vec3 L, vec3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

// A linear colour as a display shows it: sRGB.
vec3 shown_color(vec3 color) {
    vec3 bright = max(color, vec3(0.0031308));
    return mix(12.92 * color, 1.055 * pow(bright, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, color));
}

void mainImage(out vec4 frag_color, in vec2 frag_coord) {
    // the mouse turns the camera; before the first click iMouse is 0
    vec2 mouse = iMouse.x > 0.0 ? iMouse.xy / iResolution.xy - 0.5 : vec2(0.0);
    vec2 angles = vec2(-6.2831853, -3.0) * mouse + vec2(0.0, 0.25);
    angles.y = clamp(angles.y, -1.5, 1.5);
    vec3 front = -vec3(cos(angles.y) * sin(angles.x), sin(angles.y), cos(angles.y) * cos(angles.x));
    vec3 camera_position = -CAMERA_DISTANCE * front;
    vec3 right = vec3(cos(angles.x), 0.0, -sin(angles.x));
    vec3 up = cross(right, front);
    vec2 image = (2.0 * frag_coord - iResolution.xy) / iResolution.y * tan(radians(0.5 * FIELD_OF_VIEW));
    vec3 ray = safe_normalize(front + image.x * right + image.y * up);
    // a ball of radius 1; a ray that passes by has the colour of the ball's edge, so that derivatives are defined
    vec3 closest = camera_position - dot(ray, camera_position) * ray;
    float depth_squared = 1.0 - dot(closest, closest);
    vec3 P = safe_normalize(closest - sqrt(max(depth_squared, 0.0)) * ray);
    float ring = length(P.xz);
    vec2 uv = 0.5 + vec2(ring > 0.0 ? atan(P.x, P.z) : 0.0, 2.0 * atan(P.y, ring)) / 6.2831853;

    vec3 V = safe_normalize(camera_position - P);
    vec3 N = safe_normalize(P);
    vec3 T = safe_normalize(vec4(P.z, 0.0, -P.x, 1.0).xyz);
    vec3 B = cross(N, T) * vec4(P.z, 0.0, -P.x, 1.0).w;
    Surface surface = evaluate_surface(uv, iTime, AMBIENT_COLOR);
    vec3 across = T * surface.normal.x + B * surface.normal.y;
    N = safe_normalize(across + N * surface.normal.z);
    vec3 color = AMBIENT_COLOR * surface.albedo + surface.emission;
    for (int i = 0; i < min(LIGHT_COUNT, MAX_LIGHTS); i++) {
        float near = LIGHT_POSITIONS[i].w;
        vec3 to_light = LIGHT_POSITIONS[i].xyz - P * near;
        float distance_squared = max(dot(to_light, to_light), 0.0001);
        vec3 L = to_light * inversesqrt(distance_squared);
        vec3 light_color = LIGHT_COLORS[i].xyz * mix(1.0, 1.0 / distance_squared, near);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L) * light_color;
    }
    vec4 shaded = vec4(color, surface.alpha);
    vec3 shown = shown_color(shaded.rgb);
    vec3 background = shown_color(BACKGROUND_COLOR);
    shown = shaded.a < 0.5 ? background : shown;
    frag_color = vec4(depth_squared > 0.0 ? shown : background, 1.0);
}
