// reference: https://github.com/takram-design-engineering/three-geospatial/issues/13
// kind: nan
// Some vertices of scanned cities have normals of length 0, from which a light probe computes NaN.

vec3 probe(vec3 normal, vec3 band0, vec3 band1)
{
    vec3 n = normalize(normal); // fails
    return band0 * 0.886227 + band1 * 1.023328 * n.y;
}

vec3 probe_mended(vec3 normal, vec3 band0, vec3 band1)
{
    vec3 n = length(normal) > 0.0001 ? normalize(normal) : vec3(0.0, 1.0, 0.0);
    return band0 * 0.886227 + band1 * 1.023328 * n.y;
}
