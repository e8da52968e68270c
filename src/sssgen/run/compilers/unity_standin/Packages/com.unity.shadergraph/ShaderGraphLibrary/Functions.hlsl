// Stand-in (see the README above).
#ifndef SSSGEN_STANDIN_SHADER_GRAPH_FUNCTIONS
#define SSSGEN_STANDIN_SHADER_GRAPH_FUNCTIONS

bool IsGammaSpace()
{
    return false;
}

#endif
