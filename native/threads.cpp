// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "threads.h"

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>
#endif

namespace {

using sway::Threads;

// Parts of a thread, so that one that is held up delays the others little.
constexpr size_t PARTS = 32;

#if defined(_WIN32)

typedef SRWLOCK Lock;
typedef CONDITION_VARIABLE Signal;
typedef HANDLE Thread;
typedef DWORD Ended;

void begin(Lock &lock, Signal &signal) {
  InitializeSRWLock(&lock);
  InitializeConditionVariable(&signal);
}
void take(Lock &lock) { AcquireSRWLockExclusive(&lock); }
void leave(Lock &lock) { ReleaseSRWLockExclusive(&lock); }
void wait(Signal &signal, Lock &lock) { SleepConditionVariableSRW(&signal, &lock, INFINITE, 0); }
void wake(Signal &signal) { WakeAllConditionVariable(&signal); }
int64_t process() { return GetCurrentProcessId(); }

Ended WINAPI run(void *all);

bool start(Thread &thread, Threads &all) {
  thread = CreateThread(nullptr, 0, run, &all, 0, nullptr);
  return thread != nullptr;
}

void join(Thread &thread) {
  WaitForSingleObject(thread, INFINITE);
  CloseHandle(thread);
}

#else

typedef pthread_mutex_t Lock;
typedef pthread_cond_t Signal;
typedef pthread_t Thread;
typedef void *Ended;

void begin(Lock &lock, Signal &signal) {
  pthread_mutex_init(&lock, nullptr);
  pthread_cond_init(&signal, nullptr);
}
void take(Lock &lock) { pthread_mutex_lock(&lock); }
void leave(Lock &lock) { pthread_mutex_unlock(&lock); }
void wait(Signal &signal, Lock &lock) { pthread_cond_wait(&signal, &lock); }
void wake(Signal &signal) { pthread_cond_broadcast(&signal); }
int64_t process() { return getpid(); }

#define WINAPI
Ended run(void *all);

// Signals stay with the threads of the program.
bool start(Thread &thread, Threads &all) {
  sigset_t every, before;
  sigfillset(&every);
  pthread_sigmask(SIG_SETMASK, &every, &before);
  const bool is_started = pthread_create(&thread, nullptr, run, &all) == 0;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return is_started;
}

void join(Thread &thread) { pthread_join(thread, nullptr); }

#endif

}  // namespace

struct sway::Threads {
  Thread *thread;
  size_t rooms, n_started;
  int64_t process;  // which has them
  Lock lock;        // of what follows
  Signal change;
  Part part;  // null without work
  void *work;
  size_t next, count, at_once, n_busy, n_running;
  bool is_over;
};

namespace {

// Do parts until none is left, under the lock but while they are done.
void help(Threads &all, size_t room) {
  all.n_busy++;
  while (all.next < all.count) {
    const size_t first = all.next, left = all.count - first;
    const size_t count = left < all.at_once ? left : all.at_once;
    all.next += count;
    leave(all.lock);
    all.part(all.work, room, first, count);
    take(all.lock);
  }
  if (--all.n_busy == 0) wake(all.change);
}

void serve(Threads &all) {
  take(all.lock);
  const size_t room = ++all.n_running;
  while (!all.is_over)
    if (all.next < all.count)
      help(all, room);
    else
      wait(all.change, all.lock);
  leave(all.lock);
}

Ended WINAPI run(void *all) {
  serve(*static_cast<Threads *>(all));
  return {};
}

void start_all(Threads &all) {
  begin(all.lock, all.change);
  all.process = process();
  all.n_busy = all.n_running = all.next = all.count = all.n_started = 0;
  all.part = nullptr;
  while (all.n_started + 1 < all.rooms && start(all.thread[all.n_started], all)) all.n_started++;
}

}  // namespace

namespace sway {

size_t processors() {
#if defined(_WIN32)
  return GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
#elif defined(__linux__)
  cpu_set_t own;
  return sched_getaffinity(0, sizeof own, &own) ? 1 : CPU_COUNT(&own);
#else
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count > 0 ? count : 1;
#endif
}

Threads *open_threads(Memory &memory, size_t rooms) {
  Threads *all;
  Thread *thread;
  memory.take(1, all);
  memory.take(rooms - 1, thread);
  if (memory.is_short) return nullptr;
  all->thread = thread;
  all->rooms = rooms;
  start_all(*all);
  return all;
}

void share(Threads &all, size_t count, Part part, void *work) {
  if (all.process != process()) start_all(all);
  take(all.lock);
  while (all.part) wait(all.change, all.lock);
  all.part = part;
  all.work = work;
  all.next = 0;
  all.count = count;
  all.at_once = count / (PARTS * all.rooms) + 1;
  wake(all.change);
  help(all, 0);
  while (all.n_busy) wait(all.change, all.lock);
  all.part = nullptr;
  wake(all.change);
  leave(all.lock);
}

void close_threads(Threads *all) {
  if (!all || all->process != process()) return;
  take(all->lock);
  all->is_over = true;
  wake(all->change);
  leave(all->lock);
  for (size_t i = 0; i < all->n_started; i++) join(all->thread[i]);
}

}  // namespace sway
