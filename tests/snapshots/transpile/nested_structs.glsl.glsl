// nested_structs
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Corner {
    float weight;
    vec2 place;
};

struct CornerRow2 {
    Corner items[2];
};

struct FloatRow2 {
    float items[2];
};

struct FloatRow3 {
    float items[3];
};

vec2 corner(float x, int i) {
    CornerRow2 corners[2];
    corners[0].items = Corner[2](Corner(x, vec2(1.0)), Corner(2.0, vec2(x)));
    corners[1].items[0] = Corner(3.0, vec2(x, 1.0));
    corners[1].items[1] = corners[0].items[1];
    corners[1].items[i & 1].weight += 1.0;
    Corner last[2] = corners[1].items;
    return corners[i & 1].items[0].place * last[1].weight
        + vec2(corners[1].items[1].weight, float(corners == corners));
}

float sums(int i, int j) {
    FloatRow2 fixed_rows[3] = FloatRow2[3](FloatRow2(float[2](1.0, 2.0)), FloatRow2(float[2](3.0, 4.0)),
        FloatRow2(float[2](5.0, 6.0)));
    FloatRow2 free_rows[2] = FloatRow2[2](FloatRow2(float[2](1.0, 2.0)), FloatRow2(float[2](3.0, 4.0)));
    FloatRow3 listed[2] = FloatRow3[2](FloatRow3(float[3](1.0, 2.0, 3.0)),
        FloatRow3(float[3](4.0, 5.0, 6.0)));
    return fixed_rows[i & 1].items[j & 1] + free_rows[i & 1].items[j & 1] + listed[i & 1].items[j & 1];
}

int rounds(int n) {
    int sum = 0;
    for (int i = 0; ; ) {
        bool goes_on = i < n && i < 8;
        if (!goes_on) {
            break;
        }
        if (i == 3) {
            i++;
            continue;
        }
        sum += goes_on ? i : 100;
        i++;
    }
    while (true) {
        bool more = sum > 20;
        if (!more) {
            break;
        }
        sum -= more ? 7 : 0;
    }
    return sum;
}
