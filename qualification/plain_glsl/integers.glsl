// Tricks with bits, and control flow over integers.

int quarter(int a) { return a >> 2; }
int magnitude_and_rest(int a) { return abs(a) + max(a, 0); }
int limited(int x) { return clamp(x, -10, 10); }
uint top(uint x) { return x >> 28; }

bool power_of_two(uint x) { return x != 0u && (x & (x - 1u)) == 0u; }

uint round_up(uint x) {
    x--;
    x |= x >> 1; x |= x >> 2; x |= x >> 4; x |= x >> 8; x |= x >> 16;
    return x + 1u;
}

uint morton(uint x) {
    x &= 0xffffu;
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

int sign_extended(uint field) { return int(field << 20) >> 20; }

int saturated_sum(int a, int b) {
    int s = a + b;
    if (((a ^ s) & (b ^ s)) < 0) s = a < 0 ? -2147483647 - 1 : 2147483647;
    return s;
}

int average(int a, int b) { return (a & b) + ((a ^ b) >> 1); }

int kind(int code) {
    switch (code & 7) {
        case 0: return 10;
        case 1:
        case 2: code += 5;
        case 3: code *= 2; break;
        case 6: return -code;
        default: code = 7 - code;
    }
    return code > 1000 ? 1000 : code;
}

int digits(int n) {
    int count = 1;
    n = n < 0 ? -n : n;
    while (n >= 10) { n /= 10; count++; }
    return count;
}

uint gcd(uint a, uint b) {
    for (int i = 0; i < 48; i++) {
        if (b == 0u) break;
        uint t = a % b;
        a = b;
        b = t;
    }
    return a;
}

int collatz(int n) {
    int steps = 0;
    while (n > 1 && steps < 60) {
        n = (n & 1) == 0 ? n / 2 : 3 * n + 1;
        steps++;
    }
    return steps;
}

int day(int year, int month) {
    if (month == 2) return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0 ? 29 : 28;
    if (month == 4 || month == 6 || month == 9 || month == 11) return 30;
    return 31;
}

float alarm(float x) {
    if (x > 100.0) return 1.0;
    if (x < -273.15) return -1.0;
    return 0.0;
}

int bucket(float x) {
    int i = int(floor(x * 4.0));
    if (i < -8) i = -8;
    return i > 8 ? 8 : i;
}
