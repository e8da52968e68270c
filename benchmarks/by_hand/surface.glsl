// The surface techniques written by hand from their formulas.

uniform sampler2D base_color_texture;
uniform vec4 tint;
uniform sampler2D cover_texture;
uniform float cover;
uniform sampler2D height_texture;
uniform float relief;
uniform float texel_size;
uniform vec2 uv_per_unit;
uniform sampler2D normal_texture;
uniform float normal_scale;
uniform sampler2D packed_texture;
uniform vec2 red_speed;
uniform vec2 green_speed;
uniform vec2 blue_speed;
uniform vec3 vein_color;
uniform vec3 spark_color;
uniform sampler2D erosion_texture;
uniform float erosion;
uniform float edge;
uniform float edge_height;
uniform vec3 jelly_color;
uniform float cell_count;
uniform float bevel;
uniform float variation;

void base_color(vec2 uv, out vec3 albedo, out float alpha) {
    vec4 texel = tint * texture(base_color_texture, uv);
    albedo = texel.rgb;
    alpha = texel.a;
}

void ice_mask(vec2 uv, inout float through) {
    through *= smoothstep(0.0, 0.1, 1.0 - cover * texture(cover_texture, uv).r);
}

vec3 blended(vec3 base, vec3 detail) {
    return normalize(vec3(base.xy + detail.xy, base.z * detail.z));
}

void normal_from_height(vec2 uv, inout vec3 normal) {
    vec2 e = vec2(texel_size, 0.0);
    vec2 rise = vec2(
        texture(height_texture, uv + e.xy).r - texture(height_texture, uv - e.xy).r,
        texture(height_texture, uv + e.yx).r - texture(height_texture, uv - e.yx).r);
    normal = blended(normal, normalize(vec3(-relief * uv_per_unit * rise / (2.0 * texel_size), 1.0)));
}

void normal_map(vec2 uv, inout vec3 normal) {
    vec3 texel = texture(normal_texture, uv).xyz * 2.0 - 1.0;
    normal = blended(normal, vec3(texel.xy * normal_scale, texel.z));
}

void packed_scroll(vec2 uv, float time, inout vec3 emission) {
    float veins = texture(packed_texture, uv + fract(red_speed * time)).r
        * texture(packed_texture, uv + fract(green_speed * time)).g;
    emission += vein_color * veins + spark_color * texture(packed_texture, uv + fract(blue_speed * time)).b;
}

float left_at(vec2 uv) {
    return clamp((texture(erosion_texture, uv).r - mix(-edge, 1.0, erosion)) / edge, 0.0, 1.0);
}

void alpha_erosion(vec2 uv, inout float alpha, inout vec3 normal) {
    vec2 e = vec2(texel_size, 0.0);
    vec2 rise = vec2(left_at(uv + e.xy) - left_at(uv - e.xy), left_at(uv + e.yx) - left_at(uv - e.yx));
    normal = blended(normal, normalize(vec3(-edge_height * uv_per_unit * rise / (2.0 * texel_size), 1.0)));
    alpha *= left_at(uv);
}

float jelly(vec3 p) {
    vec3 q = vec3(abs(p.x - 0.725) - 0.725, p.y - 0.48, p.z);
    q = abs(vec3((q.x - q.z) * 0.70710678, q.y, (q.x + q.z) * 0.70710678)) - 0.5;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

void jelly_surface(vec3 P, out vec3 albedo, inout float th) {
    albedo = jelly_color;
    if (P.y < jelly(P)) {
        vec2 tile = mod(floor(P.xz * 2.0), 2.0);
        albedo = vec3(1.0 - 0.1 * abs(tile.x - tile.y));
        th = 0.0;
    }
}

uint scrambled(uint x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

float unit_hash(uint x) {
    return float(scrambled(x) >> 8) / 16777216.0;
}

void voronoi_normal(vec2 uv, inout vec3 normal) {
    vec2 p = uv * cell_count;
    vec2 home = floor(p);
    vec2 within = p - home;
    vec2 to_first = vec2(4.0);
    vec2 to_second = vec2(4.0);
    float first = 32.0;
    float second = 32.0;
    uint owner = 0u;
    for (int j = -1; j <= 1; j++) {
        for (int i = -1; i <= 1; i++) {
            ivec2 cell = ivec2(home) + ivec2(i, j);
            uint seed = scrambled(uint(cell.x) + scrambled(uint(cell.y) + 1u));
            vec2 jitter = vec2(unit_hash(seed + 1u), unit_hash(seed + 2u)) - 0.5;
            vec2 way = vec2(i, j) + 0.5 + 0.6 * jitter - within;
            float square = dot(way, way);
            if (square < first) {
                second = first;
                to_second = to_first;
                first = square;
                to_first = way;
                owner = seed;
            } else if (square < second) {
                second = square;
                to_second = way;
            }
        }
    }
    float near = sqrt(first);
    float next = sqrt(second);
    float x = clamp((next - near) / bevel, 0.0, 1.0);
    float steepness = (1.0 - variation * unit_hash(owner + 3u)) * 6.0 * x * (1.0 - x) / bevel;
    vec2 slope = relief * uv_per_unit * cell_count * steepness * (to_first / near - to_second / next);
    normal = blended(normal, normalize(vec3(-slope, 1.0)));
}
