// SPDX-License-Identifier: BSD-3-Clause
// A parallel region of OpenMP that one thread enters is a call. libgomp makes two system calls of it at each search in
// PCL's k-d tree. Where a virtual machine makes them slow, they take four times as long as the search: no peer may lose
// for want of a better machine. Preloaded where rows are made.

extern "C" __attribute__((visibility("default"))) void GOMP_parallel(void (*region)(void*), void* data, unsigned,
                                                                     unsigned);

extern "C" void GOMP_parallel(void (*region)(void*), void* data, unsigned /*threads*/, unsigned /*flags*/)
{
  region(data);
}
