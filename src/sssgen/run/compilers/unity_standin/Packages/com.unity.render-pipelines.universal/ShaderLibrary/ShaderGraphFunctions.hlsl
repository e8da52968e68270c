// Stand-in (see the README above): what a graph's pass includes before the nodes.
#ifndef SSSGEN_STANDIN_GRAPH_FUNCTIONS
#define SSSGEN_STANDIN_GRAPH_FUNCTIONS
#include "Packages/com.unity.shadergraph/ShaderGraphLibrary/Functions.hlsl"
#endif
