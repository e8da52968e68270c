// edges
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

struct Sphere {
    float2 center_;
    float radius;
};

struct Plane {
    float3 normal;
};

static const int FAR = 40;

cbuffer Material : register(b3) {
    int bits;
    uint mask;
    int rounds;
};

static float4 color;

uint bitfieldInsert(uint x, uint y, int z, int w) {
    uint mask = (w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u);
    return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
}

float area_Sphere(Sphere s) {
    return s.radius * s.radius;
}

float area_Plane(Plane p) {
    return p.normal.z;
}

void main_() {
    float steps[3] = { 1.0, 2.0, 3.0 };
    float3 weights = float3(0.25, 0.5, 1.0);
    int after = 7;
    int before = -1;
    Sphere sphere = { (float2)1.0, 2.0 };
    Plane plane = { (float3)0.5 };
    color = float4(area_Sphere(sphere), area_Plane(plane), 0.0, 1.0);
    if (rounds > 100) {
        color.x = steps[2] + weights[0] + float2x2(1.0, 0.0, 0.0, 1.0)[0][1];
        color.y = float(1 == 0 ? 0 : (bits << (uint(32 - (-1) - 1) & 31u)) >> (uint(32 - 1) & 31u))
            + float(2 == 0 ? 0u : (mask << (0xfffffff6u & 31u)) >> (uint(32 - 2) & 31u));
        color.z = float(bitfieldInsert(mask, 3u, 30, 9));
    }
}

float4 fragment_main() : SV_Target0 {
    main_();
    return color;
}
