// Stand-in (see the README above): a graph of HDRP knows the spaces, with positions relative to the camera, and no lights.
#ifndef SSSGEN_STANDIN_HDRP_VARIABLES
#define SSSGEN_STANDIN_HDRP_VARIABLES
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/SpaceTransforms.hlsl"
#endif
