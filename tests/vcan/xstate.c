/* Whole registers for User Mode Linux: a library that boot.sh puts before ptrace.
 *
 * Linux 6.1 as a process reads and writes 2696 bytes of the extended state (XSAVE) of its processes, to the end of AVX-512. A
 * host takes it back whole or not at all, and with AMX it is 11008 bytes: every process of the machine died at its first
 * instruction. Here what lies behind is read and written back with it. Nobody in the machine can use AMX. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

long ptrace(enum __ptrace_request request, ...) {
    static long (*real)(int, ...);
    static char state[1 << 16];
    struct iovec whole = {state, sizeof state};

    va_list rest;
    va_start(rest, request);
    int pid = va_arg(rest, int);
    void *address = va_arg(rest, void *), *data = va_arg(rest, void *);
    va_end(rest);
    if (real == NULL)
        real = (long (*)(int, ...))dlsym(RTLD_NEXT, "ptrace");
    if (request == PTRACE_SETREGSET && address == (void *)NT_X86_XSTATE &&
        real(PTRACE_GETREGSET, pid, address, &whole) == 0) {
        const struct iovec *part = data;
        if (part->iov_len < whole.iov_len) {
            memcpy(state, part->iov_base, part->iov_len);
            data = &whole;
        }
    }
    return real(request, pid, address, data);
}
