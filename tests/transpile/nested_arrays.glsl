#version 430 core
// Arrays of arrays: types, constructors, constants, uniforms, parameters, results, members, loops.

const float KERNEL[3][3] = float[3][3](float[](1.0, 2.0, 1.0), float[](2.0, 4.0, 2.0), float[](1.0, 2.0, 1.0));
const vec2 CORNERS[2][2] = { { vec2(0.0), vec2(1.0, 0.0) }, { vec2(0.0, 1.0), vec2(1.0) } };

struct Grid {
    int cells[2][3];
    float weight;
};

uniform vec3 colors[2][2];
uniform float table[3][2];
uniform float gain;

float total(float values[3][2]) {
    float sum = 0.0;
    for (int i = 0; i < values.length(); i++) {
        for (int j = 0; j < values[i].length(); j++) {
            sum += values[i][j];
        }
    }
    return sum;
}

float[2][3] doubled(float values[2][3]) {
    values[0][1] *= 2.0;
    values[1] = float[3](values[1][2], values[1][0], gain);
    return values;
}

float of_table(int i, int j) {
    float row[2] = table[i];
    return row[j] + table[2][1] * total(table);
}

float filtered(float x) {
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += KERNEL[i][j] * sin(x + float(i - j));
        }
    }
    return sum / 16.0;
}

vec2 corner(int i, int j) {
    return CORNERS[i][j] * 2.0 - CORNERS[1][1];
}

vec3 mixed_color(int i, float x) {
    return mix(colors[i][0], colors[i][1], x);
}

void fill(out int cells[2][3], int start) {
    for (int i = 0; i < 6; i++) {
        cells[i / 3][i % 3] = start + i;
    }
}

int cell(int i, int j) {
    Grid grid;
    fill(grid.cells, 5);
    Grid other = grid;
    other.cells[1] = grid.cells[0];
    other.weight = 1.0;
    return other.cells[i][j] + grid.cells[1][2];
}

float stepped(float x) {
    float[2] pairs[3] = float[][](float[](x, 1.0), float[](2.0, x), float[](x * x, 3.0));
    float changed[2][3] = doubled(float[2][3](float[3](x, x, x), float[3](1.0, 2.0, 3.0)));
    return total(pairs) + changed[0][1] + changed[1][1];
}

bool alike(float a[2][2], float b[2][2]) {
    return a == b;
}
