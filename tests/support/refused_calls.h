#pragma once
// Tests of what a program does where the system refuses something.

#include <cstddef>
#include <initializer_list>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace gi::test {

/// Exit code of in_child_without(): the system does not permit it.
inline constexpr int kNotPermitted = 64;

/// Runs a function in a copy of this process in which system calls fail, as that cannot be undone.
/// @param error  errno of these calls  @param run  returns the exit code, not kNotPermitted
/// @return it, or -1 if the copy did not exit
template <class Run>
int in_child_without(std::initializer_list<unsigned> calls, unsigned error, Run const& run)
{
    pid_t const child = fork();
    if (child == 0) {
        std::vector<sock_filter> code{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
        for (unsigned const call : calls) {
            code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
            code.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error));
        }
        code.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
        sock_fprog const program{static_cast<unsigned short>(code.size()), code.data()};
        bool const refused = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                             prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
        _exit(refused ? run() : kNotPermitted);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace gi::test
