// reference: https://github.com/google/filament/pull/643
// kind: division
// Anti-aliasing divides the direction of an edge by its smaller part, which a bias kept from 0 only in high precision.

vec2 edge(float north, float south, float east, float west) // sssgen: assume 0 <= north <= 1, 0 <= south <= 1, 0 <= east <= 1, 0 <= west <= 1
{
    vec2 direction = vec2(south - north, west - east);
    return direction / (min(abs(direction.x), abs(direction.y))); // fails
}

vec2 edge_mended(float north, float south, float east, float west) // sssgen: assume 0 <= north <= 1, 0 <= south <= 1, 0 <= east <= 1, 0 <= west <= 1
{
    vec2 direction = vec2(south - north, west - east);
    float smaller = min(abs(direction.x), abs(direction.y));
    if (smaller == 0.0) return vec2(0.0);
    return direction / smaller;
}
