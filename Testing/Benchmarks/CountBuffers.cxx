// Counts from outside what a process takes of a device: put before OpenCL (LD_PRELOAD), it adds up the buffers that
// live, but for those in host memory (CL_MEM_ALLOC_HOST_PTR), and prints the largest sum of both at the end.

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <atomic>
#include <cstdio>
#include <dlfcn.h>

namespace
{
struct Bytes
{
  std::atomic<std::size_t> now{ 0 }, most{ 0 };

  void Add(std::size_t more)
  {
    const std::size_t sum = this->now += more;
    for (std::size_t before = this->most; before < sum && !this->most.compare_exchange_weak(before, sum);)
    {
    }
  }
};

struct Counts
{
  Bytes device, host;
  ~Counts()
  {
    std::fprintf(stderr, "{\"bench\": \"buffers\", \"device_bytes\": %zu, \"host_bytes\": %zu}\n",
      static_cast<std::size_t>(this->device.most), static_cast<std::size_t>(this->host.most));
  }
} counts;

struct Counted
{
  Bytes* of;
  std::size_t bytes;
};
}

extern "C" cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t bytes, void* host, cl_int* error)
{
  static const auto real = reinterpret_cast<decltype(&clCreateBuffer)>(dlsym(RTLD_NEXT, "clCreateBuffer"));
  cl_mem memory = real(context, flags, bytes, host, error);
  if (memory)
  {
    auto* counted = new Counted{ flags & CL_MEM_ALLOC_HOST_PTR ? &counts.host : &counts.device, bytes };
    counted->of->Add(bytes);
    const auto gone = [](cl_mem, void* data) {
      auto* of = static_cast<Counted*>(data);
      of->of->now -= of->bytes;
      delete of;
    };
    clSetMemObjectDestructorCallback(memory, gone, counted);
  }
  return memory;
}
