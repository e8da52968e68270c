// nested_arrays
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef NESTED_ARRAYS_HLSL_INCLUDED
#define NESTED_ARRAYS_HLSL_INCLUDED

struct Grid {
    int cells[2][3];
    float weight;
};

static const float KERNEL[3][3] = { { 1.0, 2.0, 1.0 }, { 2.0, 4.0, 2.0 }, { 1.0, 2.0, 1.0 } };
static const float2 CORNERS[2][2] = { { (float2)0.0, float2(1.0, 0.0) }, { float2(0.0, 1.0), (float2)1.0 } };

float total(float values[3][2]) {
    float sum = 0.0;
    [unroll]
    for (int i = 0; i < 3; i++) {
        [unroll]
        for (int j = 0; j < 2; j++) {
            sum += values[i][j];
        }
    }
    return sum;
}

void doubled(float values[2][3], float gain, out float result[2][3]) {
    values[0][1] *= 2.0;
    float values_2[3] = { values[1][2], values[1][0], gain };
    values[1] = values_2;
    result = values;
}

float of_table(int i, int j, float table[6]) {
    float row[2] = { table[i * 2], table[i * 2 + 1] };
    float values[2] = { table[0], table[1] };
    float values_2[2] = { table[2], table[3] };
    float values_3[2] = { table[4], table[5] };
    float values_4[3][2] = { values, values_2, values_3 };
    return row[j] + table[5] * total(values_4);
}

float filtered(float x) {
    float sum = 0.0;
    [unroll]
    for (int i = 0; i < 3; i++) {
        [unroll]
        for (int j = 0; j < 3; j++) {
            sum += KERNEL[i][j] * sin(x + float(i - j));
        }
    }
    return sum / 16.0;
}

float2 corner(int i, int j) {
    return CORNERS[i][j] * 2.0 - CORNERS[1][1];
}

float3 mixed_color(int i, float x, float3 colors[4]) {
    return lerp(colors[i * 2], colors[i * 2 + 1], x);
}

void fill(out int cells[2][3], int start) {
    [unroll]
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

float stepped(float x, float gain) {
    float pairs[3][2] = { { x, 1.0 }, { 2.0, x }, { x * x, 3.0 } };
    float values[3] = { x, x, x };
    float values_2[3] = { 1.0, 2.0, 3.0 };
    float values_3[2][3] = { values, values_2 };
    float values_4[2][3];
    doubled(values_3, gain, values_4);
    float changed[2][3] = values_4;
    return total(pairs) + changed[0][1] + changed[1][1];
}

bool alike(float a[2][2], float b[2][2]) {
    float compared[2] = a[0];
    float compared_2[2] = b[0];
    float compared_3[2] = a[1];
    float compared_4[2] = b[1];
    return compared[0] == compared_2[0] && compared[1] == compared_2[1]
        && (compared_3[0] == compared_4[0] && compared_3[1] == compared_4[1]);
}

#endif
