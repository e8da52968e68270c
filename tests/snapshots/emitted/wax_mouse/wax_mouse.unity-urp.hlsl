// Wax mouse: A candle in the shape of a mouse: the ears glow, the body stays deep.
// Made by sssgen for Unity, Universal Render Pipeline. Change the material and emit it again rather than this file.
// #include it after URP's Core.hlsl.
#ifndef WAX_MOUSE_UNITY_URP_INCLUDED
#define WAX_MOUSE_UNITY_URP_INCLUDED

struct Surface {
    float3 albedo;
    float metallic;
    float roughness;
};

static const float NEGLIGIBLE = 1.0e-6;
static const float DARKEST = 0.0001;
static const float OPAQUE_DISTANCE = 1.0e-6;
static const float ENDLESS = 10000.0;
static const float OPAQUE_DEPTH = 80.0;

// The box's size; a flat box is padded to a thousandth of its diagonal, about its centre.
float3 box_size(float3 box_max, float3 box_min) {
    return max(box_max - box_min, (float3)(0.001 * distance(box_min, box_max)));
}

// The way from the box's centre to `p`.
float3 from_box_center(float3 p, float3 box_max, float3 box_min) {
    return p - 0.5 * (box_min + box_max);
}

// How far it is from `p`, inside the box, along `direction` to the box's side.
float box_exit(float3 p, float3 direction, float3 box_max, float3 box_min) {
    float3 exits = (0.5 * box_size(box_max, box_min) - from_box_center(p, box_max, box_min)
        * float3(sign(direction))) / max(abs(direction), 1.0e-20);
    // along a zero direction it would be endless
    return clamp(min(exits.x, min(exits.y, exits.z)), 0.0, length(box_size(box_max, box_min)));
}

// The signed distance to a mesh, from a 3-D texture that was baked over a box in object space.
float distance_texture(float3 p, float3 box_max, float3 box_min,
    TEXTURE3D_PARAM(distance_map, samplerdistance_map), float distance_range) {
    float3 uvw = clamp(from_box_center(p, box_max, box_min) / max(box_size(box_max, box_min), 1.0e-20) + 0.5,
        0.0, 1.0);
    return (2.0 * SAMPLE_TEXTURE3D_LOD(distance_map, samplerdistance_map, uvw, 0.0).r - 1.0) * distance_range;
}

// The part of a step that is inside the body, where the distance goes from `a` to `b` in a straight line.
float inside_part(float a, float b) {
    float inside = max(-a, 0.0) + max(-b, 0.0);
    float whole = abs(a) + abs(b);
    return inside / max(whole, 1.0e-20);
}

// The length inside the body from `p` to the box's side, along L.
float length_to_light(float3 p, float3 L, float3 box_max, float3 box_min,
    TEXTURE3D_PARAM(distance_map, samplerdistance_map), float distance_range) {
    float h = box_exit(p, L, box_max, box_min) / 8.0;
    float inside = 0.0;
    float before = distance_texture(p, box_max, box_min, distance_map, samplerdistance_map, distance_range);
    // it ends where the body is farther away than the box's side
    [loop]
    for (int i = 1; i <= 8 && before < h * float(9 - i); i++) {
        float after = distance_texture(p + L * (h * float(i)), box_max, box_min, distance_map,
            samplerdistance_map, distance_range);
        inside += inside_part(before, after);
        before = after;
    }
    return inside * h;
}

// Mean length, inside the body, of the light's ways to the eye: in along L, out along V.
float march_distance_texture(float3 P_object, float3 V_object, float3 L_object, float3 box_max,
    float3 box_min, TEXTURE3D_PARAM(distance_map, samplerdistance_map), float distance_range,
    float object_scale) {
    float length_of_view = box_exit(P_object, -V_object, box_max, box_min);
    float seen = 0.0;
    float way = 0.0;
    float last = 0.0;
    float before = distance_texture(P_object, box_max, box_min, distance_map, samplerdistance_map,
        distance_range);
    [loop]
    for (int i = 1; i <= 8 && before < length_of_view - last; i++) {
        float x = float(i) / 8.0;
        float t = length_of_view * x * x;
        float after = distance_texture(P_object - V_object * t, box_max, box_min, distance_map,
            samplerdistance_map, distance_range);
        float inside = (t - last) * inside_part(before, after);
        if (inside > 0.0) {
            // the light scatters in the middle of what is inside
            float middle = before < after ? last + 0.5 * inside : t - 0.5 * inside;
            way += inside
                * (seen + 0.5 * inside
                + length_to_light(P_object - V_object * middle, L_object, box_max, box_min, distance_map,
                samplerdistance_map, distance_range));
            seen += inside;
        }
        before = after;
        last = t;
    }
    if (seen < NEGLIGIBLE) {
        // a view that only grazes the body sees the light leave where it is
        return object_scale
            * length_to_light(P_object, L_object, box_max, box_min, distance_map, samplerdistance_map,
            distance_range);
    }
    float mean = way / seen;
    return object_scale * mean;
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint,
    TEXTURE2D_PARAM(base_color_texture, samplerbase_color_texture)) {
    float4 texel = tint * SAMPLE_TEXTURE2D(base_color_texture, samplerbase_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// `d` in mean free paths, 0 or more.
float optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Light that comes through coloured by what the body absorbs: deeper colours where it is thicker.
float3 absorption_tint(float d, float3 attenuation_color, float attenuation_distance, float weight) {
    float3 sigma_d = -log(clamp(attenuation_color, DARKEST, 1.0)) * optical_depth(d, attenuation_distance);
    return weight * exp(-min(sigma_d, OPAQUE_DEPTH));
}

// Everything about the surface that does not depend on a light.
Surface evaluate_surface(float2 uv, float4 tint,
    TEXTURE2D_PARAM(base_color_texture, samplerbase_color_texture), float metalness,
    float surface_roughness) {
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture, samplerbase_color_texture);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    Surface surface = { albedo, metallic, roughness };
    return surface;
}

// What one light adds from behind, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 P_object, float3 V_object, float3 L_object,
    float3 box_max, float3 box_min, TEXTURE3D_PARAM(distance_map, samplerdistance_map), float distance_range,
    float object_scale, float3 attenuation_color, float attenuation_distance, float weight) {
    float thickness = march_distance_texture(P_object, V_object, L_object, box_max, box_min, distance_map,
        samplerdistance_map, distance_range, object_scale);
    return absorption_tint(thickness, attenuation_color, attenuation_distance, weight);
}

#endif
