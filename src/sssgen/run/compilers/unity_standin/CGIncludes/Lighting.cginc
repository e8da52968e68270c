// Stand-in (see ../README.md).
#ifndef SSSGEN_STANDIN_LIGHTING
#define SSSGEN_STANDIN_LIGHTING
#include "UnityLightingCommon.cginc"
#endif
