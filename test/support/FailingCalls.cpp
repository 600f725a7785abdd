// Preloaded into a program: its n-th call of a kind, on files below a folder, fails.
//
//   MSO_FAIL="write 3"     the fourth (or: open, sync, rename, unlink)
//   MSO_FAIL_BELOW=FOLDER  calls on other files are not counted
//   MSO_CALLS=FILE         gets a byte for each call of the kind
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

template <typename F>
F* next(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}

const char* setting(const char* name) {
  const char* value = getenv(name);
  return value ? value : "";
}

bool isBelow(const char* path) {
  const char* folder = setting("MSO_FAIL_BELOW");
  return *folder && strncmp(path, folder, strlen(folder)) == 0;
}

bool isOpenBelow(int descriptor) {
  char link[64], path[4096] = "";
  snprintf(link, sizeof(link), "/proc/self/fd/%d", descriptor);
  if (syscall(SYS_readlink, link, path, sizeof(path) - 1) < 0) return false;
  return isBelow(path);
}

bool isBelow(int folder, const char* path) {
  return *path == '/' || folder == AT_FDCWD ? isBelow(path) : isOpenBelow(folder);
}

/** Whether this call is the one that fails; then errno says why. */
bool fails(const char* kind, bool isCounted, int why) {
  static std::atomic<long> calls{0};
  const char* wanted = setting("MSO_FAIL");
  const std::size_t size = strlen(kind);
  if (!isCounted || strncmp(wanted, kind, size) != 0 || wanted[size] != ' ') return false;
  if (const char* file = setting("MSO_CALLS"); *file) {
    const int counts =
        static_cast<int>(syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_APPEND | O_CREAT, 0600));
    syscall(SYS_write, counts, "x", 1);
    syscall(SYS_close, counts);
  }
  if (calls++ != atol(wanted + size)) return false;
  errno = why;
  return true;
}

bool failsToOpen(bool isCounted) { return fails("open", isCounted, EMFILE); }
bool failsToWrite(int descriptor) { return fails("write", isOpenBelow(descriptor), ENOSPC); }
bool failsToRename(bool isCounted) { return fails("rename", isCounted, EIO); }
bool failsToUnlink(bool isCounted) { return fails("unlink", isCounted, EBUSY); }

mode_t modeIn(int flags, va_list list) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
}

}  // namespace

#define OPEN(NAME)                                                     \
  int NAME(const char* path, int flags, ...) {                         \
    va_list list;                                                      \
    va_start(list, flags);                                             \
    const mode_t mode = modeIn(flags, list);                           \
    va_end(list);                                                      \
    if (failsToOpen(isBelow(path))) return -1;                         \
    return next<int(const char*, int, ...)>(#NAME)(path, flags, mode); \
  }
#define OPENAT(NAME)                                                                \
  int NAME(int folder, const char* path, int flags, ...) {                          \
    va_list list;                                                                   \
    va_start(list, flags);                                                          \
    const mode_t mode = modeIn(flags, list);                                        \
    va_end(list);                                                                   \
    if (failsToOpen(isBelow(folder, path))) return -1;                              \
    return next<int(int, const char*, int, ...)>(#NAME)(folder, path, flags, mode); \
  }
#define FOPEN(NAME)                                                  \
  FILE* NAME(const char* path, const char* mode) {                   \
    if (failsToOpen(isBelow(path))) return nullptr;                  \
    return next<FILE*(const char*, const char*)>(#NAME)(path, mode); \
  }

extern "C" {

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)

int mkdir(const char* path, mode_t mode) {
  if (failsToOpen(isBelow(path))) return -1;
  return next<int(const char*, mode_t)>("mkdir")(path, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  if (failsToWrite(file)) return -1;
  return next<ssize_t(int, const void*, size_t)>("write")(file, bytes, size);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  if (failsToWrite(file)) return -1;
  return next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64")(file, bytes, size, at);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  return pwrite64(file, bytes, size, at);
}
ssize_t writev(int file, const iovec* pieces, int number) {
  if (failsToWrite(file)) return -1;
  return next<ssize_t(int, const iovec*, int)>("writev")(file, pieces, number);
}
size_t fwrite(const void* bytes, size_t size, size_t number, FILE* file) {
  if (failsToWrite(fileno(file))) return 0;
  return next<size_t(const void*, size_t, size_t, FILE*)>("fwrite")(bytes, size, number, file);
}

int fsync(int file) {
  if (fails("sync", isOpenBelow(file), EIO)) return -1;
  return next<int(int)>("fsync")(file);
}

int rename(const char* from, const char* to) {
  if (failsToRename(isBelow(from))) return -1;
  return next<int(const char*, const char*)>("rename")(from, to);
}
int renameat2(int a, const char* from, int b, const char* to, unsigned flags) {
  if (failsToRename(isBelow(a, from))) return -1;
  return next<int(int, const char*, int, const char*, unsigned)>("renameat2")(a, from, b, to,
                                                                              flags);
}

int unlink(const char* path) {
  if (failsToUnlink(isBelow(path))) return -1;
  return next<int(const char*)>("unlink")(path);
}
int remove(const char* path) {
  if (failsToUnlink(isBelow(path))) return -1;
  return next<int(const char*)>("remove")(path);
}
int unlinkat(int folder, const char* path, int flags) {
  if (failsToUnlink(isBelow(folder, path))) return -1;
  return next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}
}
