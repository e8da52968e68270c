// reference: https://github.com/mapbox/mapbox-gl-native/issues/8751
// kind: undefined
// smoothstep with the larger edge first: on one system the outline was always 0.

float outline(float distance_to_line)
{
    return smoothstep(1.0, 0.0, distance_to_line); // fails
}

float outline_mended(float distance_to_line)
{
    return 1.0 - smoothstep(0.0, 1.0, distance_to_line);
}
