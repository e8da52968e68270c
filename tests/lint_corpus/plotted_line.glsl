// reference: https://github.com/patriciogonzalezvivo/thebookofshaders/issues/344
// kind: undefined
// A line along the diagonal, by a smoothstep whose edges are in falling order.

float plot(vec2 point, float width) // sssgen: assume 0 <= width <= 0.1
{
    return smoothstep(width, 0.0, abs(point.y - point.x)); // fails
}

float plot_mended(vec2 point, float width) // sssgen: assume 0.001 <= width <= 0.1
{
    return 1.0 - smoothstep(0.0, width, abs(point.y - point.x));
}
