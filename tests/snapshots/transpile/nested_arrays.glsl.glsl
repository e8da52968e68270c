// nested_arrays
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct IntRow3 {
    int items[3];
};

struct Grid {
    IntRow3 cells[2];
    float weight;
};

struct FloatRow2 {
    float items[2];
};

struct FloatRow3 {
    float items[3];
};

struct Vec2Row2 {
    vec2 items[2];
};

const FloatRow3 KERNEL[3] = FloatRow3[3](FloatRow3(float[3](1.0, 2.0, 1.0)),
    FloatRow3(float[3](2.0, 4.0, 2.0)), FloatRow3(float[3](1.0, 2.0, 1.0)));
const Vec2Row2 CORNERS[2] = Vec2Row2[2](Vec2Row2(vec2[2](vec2(0.0), vec2(1.0, 0.0))),
    Vec2Row2(vec2[2](vec2(0.0, 1.0), vec2(1.0))));

float total(FloatRow2 values[3]) {
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 2; j++) {
            sum += values[i].items[j];
        }
    }
    return sum;
}

FloatRow3[2] doubled(FloatRow3 values[2], float gain) {
    values[0].items[1] *= 2.0;
    values[1].items = float[3](values[1].items[2], values[1].items[0], gain);
    return values;
}

float of_table(int i, int j, float table[6]) {
    float row[2] = float[2](table[i * 2], table[i * 2 + 1]);
    return row[j] + table[5]
        * total(FloatRow2[3](FloatRow2(float[2](table[0], table[1])),
        FloatRow2(float[2](table[2], table[3])), FloatRow2(float[2](table[4], table[5]))));
}

float filtered(float x) {
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += KERNEL[i].items[j] * sin(x + float(i - j));
        }
    }
    return sum / 16.0;
}

vec2 corner(int i, int j) {
    return CORNERS[i].items[j] * 2.0 - CORNERS[1].items[1];
}

vec3 mixed_color(int i, float x, vec3 colors[4]) {
    return mix(colors[i * 2], colors[i * 2 + 1], x);
}

void fill(out IntRow3 cells[2], int start) {
    for (int i = 0; i < 6; i++) {
        cells[i / 3].items[i % 3] = start + i;
    }
}

int cell(int i, int j) {
    Grid grid;
    fill(grid.cells, 5);
    Grid other = grid;
    other.cells[1].items = grid.cells[0].items;
    other.weight = 1.0;
    return other.cells[i].items[j] + grid.cells[1].items[2];
}

float stepped(float x, float gain) {
    FloatRow2 pairs[3] = FloatRow2[3](FloatRow2(float[2](x, 1.0)), FloatRow2(float[2](2.0, x)),
        FloatRow2(float[2](x * x, 3.0)));
    FloatRow3 changed[2] = doubled(FloatRow3[2](FloatRow3(float[3](x, x, x)),
        FloatRow3(float[3](1.0, 2.0, 3.0))), gain);
    return total(pairs) + changed[0].items[1] + changed[1].items[1];
}

bool alike(FloatRow2 a[2], FloatRow2 b[2]) {
    return a == b;
}
