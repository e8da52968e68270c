// Wax mouse: A candle in the shape of a mouse: the ears glow, the body stays deep.
// Made by sssgen for Unity Shader Graph, Custom Function. Change the material and emit it again rather than this file.
// A Custom Function node of Type "File": Name WaxMouse, Source this file, and these ports in this order.
//   uv: UV
//   P: Position, World
//   P_object: Position, Object
//   V_object: View Direction, Object
// The rest are properties of the graph. The _half entry has the same ports and computes in float.
#ifndef WAX_MOUSE_UNITY_SHADERGRAPH_INCLUDED
#define WAX_MOUSE_UNITY_SHADERGRAPH_INCLUDED

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
float distance_texture(float3 p, float3 box_max, float3 box_min, UnityTexture3D distance_map,
    UnitySamplerState distance_map_sampler, float distance_range) {
    float3 uvw = clamp(from_box_center(p, box_max, box_min) / max(box_size(box_max, box_min), 1.0e-20) + 0.5,
        0.0, 1.0);
    return (2.0 * SAMPLE_TEXTURE3D_LOD(distance_map, distance_map_sampler, uvw, 0.0).r - 1.0)
        * distance_range;
}

// The part of a step that is inside the body, where the distance goes from `a` to `b` in a straight line.
float inside_part(float a, float b) {
    float inside = max(-a, 0.0) + max(-b, 0.0);
    float whole = abs(a) + abs(b);
    return inside / max(whole, 1.0e-20);
}

// The length inside the body from `p` to the box's side, along L.
float length_to_light(float3 p, float3 L, float3 box_max, float3 box_min, UnityTexture3D distance_map,
    UnitySamplerState distance_map_sampler, float distance_range) {
    float h = box_exit(p, L, box_max, box_min) / 8.0;
    float inside = 0.0;
    float before = distance_texture(p, box_max, box_min, distance_map, distance_map_sampler, distance_range);
    // it ends where the body is farther away than the box's side
    [loop]
    for (int i = 1; i <= 8 && before < h * float(9 - i); i++) {
        float after = distance_texture(p + L * (h * float(i)), box_max, box_min, distance_map,
            distance_map_sampler, distance_range);
        inside += inside_part(before, after);
        before = after;
    }
    return inside * h;
}

// Mean length, inside the body, of the light's ways to the eye: in along L, out along V.
float march_distance_texture(float3 P_object, float3 V_object, float3 L_object, float3 box_max,
    float3 box_min, UnityTexture3D distance_map, UnitySamplerState distance_map_sampler,
    float distance_range, float object_scale) {
    float length_of_view = box_exit(P_object, -V_object, box_max, box_min);
    float seen = 0.0;
    float way = 0.0;
    float last = 0.0;
    float before = distance_texture(P_object, box_max, box_min, distance_map, distance_map_sampler,
        distance_range);
    [loop]
    for (int i = 1; i <= 8 && before < length_of_view - last; i++) {
        float x = float(i) / 8.0;
        float t = length_of_view * x * x;
        float after = distance_texture(P_object - V_object * t, box_max, box_min, distance_map,
            distance_map_sampler, distance_range);
        float inside = (t - last) * inside_part(before, after);
        if (inside > 0.0) {
            // the light scatters in the middle of what is inside
            float middle = before < after ? last + 0.5 * inside : t - 0.5 * inside;
            way += inside
                * (seen + 0.5 * inside
                + length_to_light(P_object - V_object * middle, L_object, box_max, box_min, distance_map,
                distance_map_sampler, distance_range));
            seen += inside;
        }
        before = after;
        last = t;
    }
    if (seen < NEGLIGIBLE) {
        // a view that only grazes the body sees the light leave where it is
        return object_scale
            * length_to_light(P_object, L_object, box_max, box_min, distance_map, distance_map_sampler,
            distance_range);
    }
    float mean = way / seen;
    return object_scale * mean;
}

// Colour and opacity from a texture and a tint.
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler) {
    float4 texel = tint * SAMPLE_TEXTURE2D(base_color_texture, base_color_texture_sampler, uv);
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
Surface evaluate_surface(float2 uv, float4 tint, UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler, float metalness, float surface_roughness) {
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture, base_color_texture_sampler);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    Surface surface = { albedo, metallic, roughness };
    return surface;
}

// What one light adds from behind, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 P_object, float3 V_object, float3 L_object,
    float3 box_max, float3 box_min, UnityTexture3D distance_map, UnitySamplerState distance_map_sampler,
    float distance_range, float object_scale, float3 attenuation_color, float attenuation_distance,
    float weight) {
    float thickness = march_distance_texture(P_object, V_object, L_object, box_max, box_min, distance_map,
        distance_map_sampler, distance_range, object_scale);
    return absorption_tint(thickness, attenuation_color, attenuation_distance, weight);
}

// v / |v|; 0 stays 0, of which normalize makes NaN.
float3 unit_vector(float3 v) {
    float square = dot(v, v);
    return square > 1e-30 ? v * rsqrt(square) : float3(0.0, 0.0, 0.0);
}

void WaxMouse_float(
    float2 uv,
    float3 P,
    float3 P_object,
    float3 V_object,
    float3 box_max,
    float3 box_min,
    float distance_range,
    float object_scale,
    float4 tint,
    float metalness,
    float surface_roughness,
    float3 attenuation_color,
    float attenuation_distance,
    float weight,
    UnityTexture3D distance_map,
    UnitySamplerState distance_map_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    out float3 BaseColor,
    out float3 NormalTS,
    out float Metallic,
    out float Smoothness,
    out float Occlusion,
    out float3 Emission,
    out float Alpha) {
    Surface surface = evaluate_surface(uv, tint, base_color_texture, base_color_texture_sampler, metalness, surface_roughness);
    BaseColor = surface.albedo;
    NormalTS = float3(0.0, 0.0, 1.0);
    Metallic = surface.metallic;
    Smoothness = 1.0 - surface.roughness;
    Occlusion = 1.0;
    Emission = 0.0;
    Alpha = 1.0;

    // Goes to Emission, without shadow: light that comes through entered on the far side, in the object's own shadow.
#if defined(SHADERGRAPH_PREVIEW)
    float3 L = normalize(float3(0.5, 0.5, -0.5));
    float3 light_color = 1.0;
    Emission += evaluate_translucency(surface, P_object, V_object, unit_vector(mul((float3x3)GetWorldToObjectMatrix(), L)), box_max, box_min, distance_map, distance_map_sampler, distance_range, object_scale, attenuation_color, attenuation_distance, weight) * light_color;
#else
    Light light = GetMainLight();
    float3 L = light.direction;
    float3 light_color = light.color * light.distanceAttenuation;
    Emission += evaluate_translucency(surface, P_object, V_object, unit_vector(mul((float3x3)GetWorldToObjectMatrix(), L)), box_max, box_min, distance_map, distance_map_sampler, distance_range, object_scale, attenuation_color, attenuation_distance, weight) * light_color;
#if defined(_ADDITIONAL_LIGHTS)
    InputData inputData = (InputData)0;
    inputData.positionWS = P;
    inputData.normalizedScreenSpaceUV = ComputeNormalizedDeviceCoordinates(P, GetWorldToHClipMatrix());
    uint light_count = GetAdditionalLightsCount();
    LIGHT_LOOP_BEGIN(light_count)
        light = GetAdditionalLight(lightIndex, P);
        L = light.direction;
        light_color = light.color * light.distanceAttenuation;
        Emission += evaluate_translucency(surface, P_object, V_object, unit_vector(mul((float3x3)GetWorldToObjectMatrix(), L)), box_max, box_min, distance_map, distance_map_sampler, distance_range, object_scale, attenuation_color, attenuation_distance, weight) * light_color;
    LIGHT_LOOP_END
#endif
#endif
}

void WaxMouse_half(
    half2 uv,
    half3 P,
    half3 P_object,
    half3 V_object,
    half3 box_max,
    half3 box_min,
    half distance_range,
    half object_scale,
    half4 tint,
    half metalness,
    half surface_roughness,
    half3 attenuation_color,
    half attenuation_distance,
    half weight,
    UnityTexture3D distance_map,
    UnitySamplerState distance_map_sampler,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    out half3 BaseColor,
    out half3 NormalTS,
    out half Metallic,
    out half Smoothness,
    out half Occlusion,
    out half3 Emission,
    out half Alpha) {
    WaxMouse_float(uv, P, P_object, V_object, box_max, box_min, distance_range, object_scale, tint, metalness, surface_roughness, attenuation_color, attenuation_distance, weight, distance_map, distance_map_sampler, base_color_texture, base_color_texture_sampler, BaseColor, NormalTS, Metallic, Smoothness, Occlusion, Emission, Alpha);
}

#endif
