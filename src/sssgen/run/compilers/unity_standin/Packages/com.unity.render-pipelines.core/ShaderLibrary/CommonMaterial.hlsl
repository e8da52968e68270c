// Stand-in (see the README above). Shadows.hlsl needs it and does not include it, as in Unity's.
#ifndef SSSGEN_STANDIN_COMMON_MATERIAL
#define SSSGEN_STANDIN_COMMON_MATERIAL

real LerpWhiteTo(real b, real t)
{
    return 1.0 - t + b * t;
}

#endif
