// Stand-in (see the README above).
#ifndef SSSGEN_STANDIN_COLOR
#define SSSGEN_STANDIN_COLOR
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"

real Luminance(real3 color)
{
    return dot(color, real3(0.2126, 0.7152, 0.0722));
}

real3 SRGBToLinear(real3 color)
{
    return pow(max(color, 0.0), 2.2);
}

real3 LinearToSRGB(real3 color)
{
    return pow(max(color, 0.0), 1.0 / 2.2);
}

#endif
