// Independent jobs on a few threads.
#pragma once

#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace hyst {

// Calls job(0) .. job(count - 1), each once, job(i) on thread i modulo `threads`; the calling thread
// is one of them. The first exception thrown is thrown again here, when all have ended.
template <class Job>
void parallel(std::size_t count, std::size_t threads, const Job &job) {
    if (threads > count) threads = count;
    if (threads <= 1) {
        for (std::size_t i = 0; i < count; ++i) job(i);
        return;
    }
    std::vector<std::exception_ptr> failures(threads);
    const auto work = [&](std::size_t thread) {
        try {
            for (std::size_t i = thread; i < count; i += threads) job(i);
        } catch (...) {
            failures[thread] = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    for (std::size_t thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
    work(0);
    for (std::thread &other : others) other.join();
    for (const std::exception_ptr &failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

}  // namespace hyst
