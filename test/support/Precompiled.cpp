// Stands for the tests, which use the headers that are precompiled with it.
int main() {}
