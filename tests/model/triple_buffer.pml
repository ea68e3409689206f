/* The exchange protocol of rt/triple_buffer.h on a machine with explicit store buffers; see spsc_ring.pml for the
 * memory model and how to run it. The exchange itself is one indivisible step on memory; its order decides what may
 * pass it:
 *   release   the writer's earlier stores have left its buffer; the reader's earlier looks are over
 *   acquire   no later store of the writer, no later look of the reader, comes before it
 *
 * -DPUBLISH_RELAXED       no release in publish(): the index overtakes the contents
 * -DPUBLISH_RELEASE_ONLY  no acquire in publish(): the next contents go into the buffer that will be had in return
 *                         before it is had
 * -DREFRESH_RELAXED       no acquire in refresh(): the contents are read before they are had
 * -DREFRESH_ACQUIRE_ONLY  no release in refresh(): the last look at the buffer comes after it was given back
 * Each must be caught; none given must pass. */

#ifndef ITEMS
#define ITEMS 4
#endif
#define FRESH 4

byte word0[3]; /* memory: two words of three buffers */
byte word1[3];
byte middle = 1;

#define ROOM 4
byte w_word[ROOM];
byte w_at[ROOM];
byte w_value[ROOM];
byte w_n;

/* The writer's stores are plain and go to different places: any may leave first, those to one place in order. */
active proctype store_buffer() {
  byte i, k;
  bool ok;
end:
  do
  :: atomic {
      w_n > 0 ->
      i = 0;
      do
      :: i + 1 < w_n -> i++
      :: true -> break
      od;
      ok = true;
      k = 0;
      do
      :: k < i && w_word[k] == w_word[i] && w_at[k] == w_at[i] -> ok = false; k++
      :: k < i && !(w_word[k] == w_word[i] && w_at[k] == w_at[i]) -> k++
      :: k >= i -> break
      od;
      if
      :: ok ->
        if
        :: w_word[i] == 0 -> word0[w_at[i]] = w_value[i]
        :: else -> word1[w_at[i]] = w_value[i]
        fi;
        k = i;
        do
        :: k + 1 < w_n -> w_word[k] = w_word[k + 1]; w_at[k] = w_at[k + 1]; w_value[k] = w_value[k + 1]; k++
        :: else -> break
        od;
        w_n--;
        w_word[w_n] = 0; w_at[w_n] = 0; w_value[w_n] = 0
      :: else -> skip
      fi;
      i = 0; k = 0; ok = false
    }
  od
}

inline put(w, a, v) {
  atomic {
    w_n < ROOM ->
    w_word[w_n] = w; w_at[w_n] = a; w_value[w_n] = v; w_n++
  }
}

active proctype writer() {
  byte back = 0, old = 0, next = 1, guess = 0;
  bool early = false;
  do
  :: next <= ITEMS ->
    if
    :: early -> skip /* already written, before the buffer was ours */
    :: else -> put(0, back, next); put(1, back, next)
    fi;
    early = false;
#ifndef PUBLISH_RELAXED
    (w_n == 0); /* release */
#endif
#ifdef PUBLISH_RELEASE_ONLY
    if
    :: next < ITEMS ->
      if
      :: guess = 0
      :: guess = 1
      :: guess = 2
      fi;
      if
      :: guess != back -> early = true; word0[guess] = next + 1; word1[guess] = next + 1
      :: else -> skip
      fi
    :: true -> skip
    fi;
#endif
    atomic {
      old = middle;
      middle = back + FRESH
    }
    back = old % FRESH;
    if
    :: early && guess != back -> goto not_taken /* a wrong guess: no machine goes this way */
    :: else -> skip
    fi;
    next++
  :: else -> break
  od;
not_taken:
  skip
}

active proctype reader() {
  byte front = 2, old = 0, a = 0, b = 0, last = 0, guess = 0;
end:
  do
  :: middle >= FRESH ->
#ifdef REFRESH_RELAXED
    if
    :: guess = 0
    :: guess = 1
    :: guess = 2
    fi;
    a = word0[guess]; b = word1[guess];
    atomic {
      old = middle;
      middle = front
    }
    front = old % FRESH;
    if
    :: guess != front -> goto not_taken
    :: else -> skip
    fi;
#else
    atomic {
      old = middle;
      middle = front
    }
    front = old % FRESH;
    a = word0[front];
#ifdef REFRESH_ACQUIRE_ONLY
    if
    :: middle >= FRESH -> /* given back for the next one before the look at the second word */
      guess = front;
      atomic {
        old = middle;
        middle = front
      }
      front = old % FRESH;
      b = word1[guess];
      assert(a == b);
      a = word0[front]
    :: true -> skip
    fi;
#endif
    b = word1[front];
#endif
    assert(a == b && a > last); /* whole, and newer than the one before */
    last = a
  :: last == ITEMS -> break
  od;
not_taken:
  skip
}
