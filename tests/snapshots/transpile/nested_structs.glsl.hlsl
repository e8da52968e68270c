// nested_structs
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef NESTED_STRUCTS_HLSL_INCLUDED
#define NESTED_STRUCTS_HLSL_INCLUDED

struct Corner {
    float weight;
    float2 place;
};

float2 corner(float x, int i) {
    Corner corners[2][2];
    Corner corner = { x, (float2)1.0 };
    Corner corner_2 = { 2.0, (float2)x };
    Corner values[2] = { corner, corner_2 };
    corners[0] = values;
    Corner corner_3 = { 3.0, float2(x, 1.0) };
    corners[1][0] = corner_3;
    corners[1][1] = corners[0][1];
    corners[1][i & 1].weight += 1.0;
    Corner last[2] = corners[1];
    Corner compared[2] = corners[0];
    Corner compared_2[2] = corners[0];
    Corner compared_3 = compared[0];
    Corner compared_4 = compared_2[0];
    Corner compared_5 = compared[1];
    Corner compared_6 = compared_2[1];
    Corner compared_7[2] = corners[1];
    Corner compared_8[2] = corners[1];
    Corner compared_9 = compared_7[0];
    Corner compared_10 = compared_8[0];
    Corner compared_11 = compared_7[1];
    Corner compared_12 = compared_8[1];
    return corners[i & 1][0].place * last[1].weight
        + float2(corners[1][1].weight,
        float(compared_3.weight == compared_4.weight && all(compared_3.place == compared_4.place)
        && (compared_5.weight == compared_6.weight && all(compared_5.place == compared_6.place))
        && (compared_9.weight == compared_10.weight && all(compared_9.place == compared_10.place)
        && (compared_11.weight == compared_12.weight && all(compared_11.place == compared_12.place)))));
}

float sums(int i, int j) {
    float fixed_rows[3][2] = { { 1.0, 2.0 }, { 3.0, 4.0 }, { 5.0, 6.0 } };
    float free_rows[2][2] = { { 1.0, 2.0 }, { 3.0, 4.0 } };
    float listed[2][3] = { { 1.0, 2.0, 3.0 }, { 4.0, 5.0, 6.0 } };
    return fixed_rows[i & 1][j & 1] + free_rows[i & 1][j & 1] + listed[i & 1][j & 1];
}

int rounds(int n) {
    int sum = 0;
    [loop]
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
    [loop]
    while (true) {
        bool more = sum > 20;
        if (!more) {
            break;
        }
        sum -= more ? 7 : 0;
    }
    return sum;
}

#endif
