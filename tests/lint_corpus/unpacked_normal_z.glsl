// reference: https://github.com/godotengine/godot/issues/19994
// kind: nan
// The z of a normal from two channels of a compressed texture: x² + y² can be above 1.

uniform sampler2D normals;

vec3 unpacked(vec2 uv)
{
    vec2 xy = texture(normals, uv).xy * 2.0 - 1.0;
    float z = sqrt(1.0 - xy.x * xy.x - xy.y * xy.y); // fails
    return vec3(xy, z);
}

vec3 unpacked_mended(vec2 uv)
{
    vec2 xy = texture(normals, uv).xy * 2.0 - 1.0;
    float z = sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0));
    return vec3(xy, z);
}
