// Stand-in (see the README above): a node's preview knows the spaces, and no lights.
#ifndef SSSGEN_STANDIN_GRAPH_VARIABLES
#define SSSGEN_STANDIN_GRAPH_VARIABLES
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/SpaceTransforms.hlsl"
#endif
