// reference: https://github.com/BachiLi/redner/issues/21
// kind: nan
// The sine of the angle to the pole, where the direction's y rounds to more than 1.

float sine_of(vec3 direction) // sssgen: assume unit direction
{
    return sqrt(1.0 - direction.y * direction.y); // fails
}

float sine_of_mended(vec3 direction) // sssgen: assume unit direction
{
    return sqrt(max(1.0 - direction.y * direction.y, 0.0));
}
