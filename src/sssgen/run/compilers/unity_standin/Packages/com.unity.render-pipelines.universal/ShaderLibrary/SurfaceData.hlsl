// Stand-in (see the README above).
#ifndef SSSGEN_STANDIN_SURFACE_DATA
#define SSSGEN_STANDIN_SURFACE_DATA

struct SurfaceData
{
    half3 albedo;
    half3 specular;
    half metallic;
    half smoothness;
    half3 normalTS;
    half3 emission;
    half occlusion;
    half alpha;
    half clearCoatMask;
    half clearCoatSmoothness;
};

#endif
