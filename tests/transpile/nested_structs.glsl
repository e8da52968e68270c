#version 430 core
// Arrays of arrays of structs, and lengths that the values give.

struct Corner {
    float weight;
    vec2 place;
};

vec2 corner(float x, int i) {
    Corner corners[2][2];
    corners[0] = Corner[2](Corner(x, vec2(1.0)), Corner(2.0, vec2(x)));
    corners[1][0] = Corner(3.0, vec2(x, 1.0));
    corners[1][1] = corners[0][1];
    corners[1][i & 1].weight += 1.0;
    Corner last[2] = corners[1];
    return corners[i & 1][0].place * last[1].weight + vec2(corners[1][1].weight, float(corners == corners));
}

float sums(int i, int j) {
    float fixed_rows[][2] = float[][](float[2](1.0, 2.0), float[2](3.0, 4.0), float[2](5.0, 6.0));
    float[][] free_rows = float[][](float[](1.0, 2.0), float[](3.0, 4.0));
    float listed[][] = { { 1.0, 2.0, 3.0 }, { 4.0, 5.0, 6.0 } };
    return fixed_rows[i & 1][j & 1] + free_rows[i & 1][j & 1] + listed[i & 1][j & 1];
}

int rounds(int n) {
    int sum = 0;
    for (int i = 0; bool goes_on = i < n && i < 8; i++) {
        if (i == 3) {
            continue;
        }
        sum += goes_on ? i : 100;
    }
    while (bool more = sum > 20) {
        sum -= more ? 7 : 0;
    }
    return sum;
}
