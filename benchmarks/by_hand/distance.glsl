// The distance functions written by hand from their formulas.

uniform vec3 center;
uniform float radius;
uniform vec3 half_size;
uniform vec3 start;
uniform vec3 end;
uniform float ring_radius;
uniform float tube_radius;
uniform vec3 box_min;
uniform vec3 box_max;
uniform sampler3D distance_map;
uniform float distance_range;
uniform mat4 world_to_object;
uniform float object_scale;

float sphere(vec3 p) {
    return length(p - center) - radius;
}

float box(vec3 p) {
    vec3 q = abs(p - center) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float capsule(vec3 p) {
    vec3 from = p - start;
    vec3 axis = end - start;
    return length(from - axis * clamp(dot(from, axis) / dot(axis, axis), 0.0, 1.0)) - radius;
}

float torus(vec3 p) {
    p -= center;
    return length(vec2(length(p.xz) - ring_radius, p.y)) - tube_radius;
}

float jelly_cubes(vec3 p) {
    // the cubes mirror one another
    vec3 q = vec3(abs(p.x - 0.725) - 0.725, p.y - 0.48, p.z);
    q = abs(vec3((q.x - q.z) * 0.70710678, q.y, (q.x + q.z) * 0.70710678)) - 0.5;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float jelly_scene(vec3 p) {
    return min(p.y, jelly_cubes(p));
}

float distance_texture(vec3 p) {
    vec3 uvw = clamp((p - box_min) / (box_max - box_min), 0.0, 1.0);
    return (2.0 * textureLod(distance_map, uvw, 0.0).r - 1.0) * distance_range;
}

float distance_texture_world(vec3 p) {
    vec3 at = (world_to_object * vec4(p, 1.0)).xyz;
    float outside = length(max(max(box_min - at, at - box_max), 0.0));
    float stored = distance_texture(at);
    return object_scale * (outside > 0.0 ? length(vec2(outside, max(stored, 0.0))) : stored);
}
