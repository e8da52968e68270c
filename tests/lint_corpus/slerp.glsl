// reference: https://github.com/google/filament/pull/1757
// kind: nan
// The angle between two unit quaternions, whose dot product rounds to more than 1.

float angle(vec4 p, vec4 q) // sssgen: assume unit p, unit q
{
    return acos(abs(dot(p, q))); // fails
}

float angle_mended(vec4 p, vec4 q) // sssgen: assume unit p, unit q
{
    return acos(min(abs(dot(p, q)), 1.0));
}
