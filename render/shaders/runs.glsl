// Numbers given to placed things one run after the other.
uniform usamplerBuffer runs;  // first number, instance, first thing in the part's list, number of its first primitive; by first number
uniform int run_count;

uvec4 run_of(uint number) {
  int lo = 0, hi = run_count - 1;
  while (lo < hi) {
    int middle = (lo + hi + 1) >> 1;
    if (texelFetch(runs, middle).x <= number) lo = middle; else hi = middle - 1;
  }
  return texelFetch(runs, lo);
}
