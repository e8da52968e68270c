// stores
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef STORES_HLSL_INCLUDED
#define STORES_HLSL_INCLUDED

struct Ray {
    float3 from;
    float3 towards;
};

struct Hit {
    Ray ray;
    float far[3];
    float3x3 frame;
};

float4 swizzles(float4 v, float x) {
    v.xy = v.yx;
    v.zw *= 2.0;
    v.b += x;
    v.wx -= float2(x, 1.0);
    v.xyz = v.zxy;
    v[2] = x;
    v[3] /= 2.0;
    return v;
}

float3x3 columns(float3x3 m, float3 v, int i) {
    m[0] = v;
    m[1].xz = v.zx;
    m[2][1] = 4.0;
    m[1][2] += v.y;
    int place = i & 1;
    float3 m_new = m[i & 1] * 0.5;
    m = float3x3(place == 0 ? m_new : m[0], place == 1 ? m_new : m[1], place == 2 ? m_new : m[2]);
    return m;
}

float elements(float x, int i) {
    float2 points[3] = { (float2)x, float2(1.0, x), (float2)0.0 };
    points[1].y = 2.0;
    points[2] += points[0];
    points[i & 1].x -= 1.0;
    return points[0].x + points[1].x * points[1].y + points[2].x;
}

Hit members(Ray ray, float x) {
    Hit hit;
    hit.ray = ray;
    hit.ray.towards.xy *= x;
    float values[3] = { x, 1.0, 2.0 };
    hit.far = values;
    hit.far[1] -= x;
    hit.frame = float3x3(x, 0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, x);
    hit.frame[1].zx = ray.from.xy;
    hit.frame[2][0] = x;
    hit.ray.from = mul(ray.from, hit.frame);
    return hit;
}

float of_a_hit(Hit hit) {
    return dot(hit.ray.from, hit.ray.towards) + hit.far[0] * hit.far[1] + hit.frame[1].z;
}

float whole_structs(float3 v, float x) {
    Ray one = { v, (float3)x };
    Ray two = one;
    two.from.y = x;
    bool same = all(one.from == two.from) && all(one.towards == two.towards);
    return same ? one.from.y : two.from.x + of_a_hit(members(two, x));
}

void whole_numbers(inout int3 n, inout uint bits) {
    n.xy %= 7;
    n.z <<= 1;
    bits |= 5u;
    bits ^= uint(n.x);
    bits &= 255u;
    bits >>= 1;
}

#endif
