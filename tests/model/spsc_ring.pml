/* The index protocol of rt/spsc_ring.h on a machine with explicit store buffers. Checked exhaustively by
 * tools/figures/runtime.sh:  spin -a spsc_ring.pml && cc -O2 -o pan pan.c && ./pan -m100000
 *
 * Memory model: each thread's stores go into a buffer of its own and reach memory later. Memory order is what the buffer
 * keeps of the program's order:
 *   release store   leaves only when all stores before it have left
 *   relaxed store   any store may leave before any older one to another place (per place in order: coherence)
 * and loads may be satisfied early:
 *   acquire load    nothing after it is read before it
 *   relaxed load    what follows may have been read before: the reader may hold an older copy of the slot
 * A thread reads its own buffered stores first. This is weaker than x86 and as weak as Armv8 where the ring is
 * concerned: two indices, each written by one thread, and slots.
 *
 * -DWRITE_RELAXED    publish() stores its index relaxed
 * -DREAD_RELAXED     front() loads the writer's index relaxed
 * -DPOP_RELAXED      pop() stores its index relaxed (its earlier slot reads may then come after it)
 * -DCLAIM_RELAXED    try_claim() loads the reader's index relaxed (its later slot writes may then go before)
 * -DRELEASE_ONLY     both loads relaxed, both stores release: half of a pair is none
 * Each must be caught; none given must pass. */

#ifndef SLOTS
#define SLOTS 2
#endif
#ifndef ITEMS
#define ITEMS 5
#endif
#define WORDS 2 /* of a slot: a torn item shows as words that differ */

#ifdef RELEASE_ONLY
#define READ_RELAXED
#define CLAIM_RELAXED
#endif

byte slot0[SLOTS]; /* memory */
byte slot1[SLOTS];
byte write_index;
byte read_index;

/* The writer's store buffer: slot words and indices in program order. place 0: word 0, 1: word 1, 2: write_index. */
#define ROOM 6
byte w_place[ROOM];
byte w_at[ROOM];
byte w_value[ROOM];
byte w_n;

bool writer_done = false;

/* Takes entry i out of the buffer into memory. */
inline leave(i) {
  if
  :: w_place[i] == 0 -> slot0[w_at[i]] = w_value[i]
  :: w_place[i] == 1 -> slot1[w_at[i]] = w_value[i]
  :: w_place[i] == 2 -> write_index = w_value[i]
  fi;
  k = i;
  do
  :: k + 1 < w_n -> w_place[k] = w_place[k + 1]; w_at[k] = w_at[k + 1]; w_value[k] = w_value[k + 1]; k++
  :: else -> break
  od;
  w_n--;
  w_place[w_n] = 0; w_at[w_n] = 0; w_value[w_n] = 0;
  k = 0
}

/* May entry i leave before the older ones? Not before one to the same place; a release index not before any. */
inline may_leave(i) {
  ok = true;
  k = 0;
  do
  :: k < i ->
    if
    :: w_place[k] == w_place[i] && w_at[k] == w_at[i] -> ok = false
#ifndef WRITE_RELAXED
    :: w_place[i] == 2 -> ok = false
#endif
    :: else -> skip
    fi;
    k++
  :: else -> break
  od;
  k = 0
}

/* The memory system: any permitted entry may leave at any time. */
active proctype store_buffer() {
  byte i, k;
  bool ok;
end:
  do
  :: atomic {
      w_n > 0 ->
      i = 0;
      do /* choose one */
      :: i + 1 < w_n -> i++
      :: true -> break
      od;
      may_leave(i);
      if
      :: ok -> leave(i)
      :: else -> skip
      fi;
      i = 0; ok = false
    }
  od
}

inline put(p, a, v) {
  atomic {
    w_n < ROOM ->
    w_place[w_n] = p; w_at[w_n] = a; w_value[w_n] = v; w_n++
  }
}

active proctype writer() {
  byte index = 0, cached_read = 0, next = 1;
  do
  :: next <= ITEMS ->
#ifdef CLAIM_RELAXED
    /* Slot writes may go to memory before the load that permits them: the value is guessed, and the load made after.
     * A machine does so only where the guess turns out right, so a wrong guess ends this path. */
    if
    :: index - cached_read >= SLOTS ->
      put(0, index % SLOTS, next); put(1, index % SLOTS, next);
      cached_read = read_index;
      if
      :: index - cached_read >= SLOTS -> goto not_taken
      :: else -> skip
      fi
    :: else -> put(0, index % SLOTS, next); put(1, index % SLOTS, next)
    fi;
#else
    do
    :: index - cached_read >= SLOTS -> (read_index != cached_read); cached_read = read_index
    :: else -> break
    od;
    put(0, index % SLOTS, next);
    put(1, index % SLOTS, next);
#endif
    index++;
    put(2, 0, index);
    next++
  :: else -> break
  od;
  writer_done = true;
not_taken:
  skip
}

active proctype reader() {
  byte index = 0, cached_write = 0, expected = 1, a, b, early0, early1;
  do
  :: expected <= ITEMS ->
    if
    :: index == cached_write ->
#ifdef READ_RELAXED
      /* The slot may have been read before the index. */
      if
      :: early0 = slot0[index % SLOTS]; early1 = slot1[index % SLOTS];
        (write_index != cached_write); cached_write = write_index;
        a = early0; b = early1
      :: (write_index != cached_write); cached_write = write_index;
        a = slot0[index % SLOTS]; b = slot1[index % SLOTS]
      fi
#else
      (write_index != cached_write); cached_write = write_index;
      a = slot0[index % SLOTS];
#ifdef POP_RELAXED
      goto pop_first;
#endif
      b = slot1[index % SLOTS]
#endif
    :: else ->
      a = slot0[index % SLOTS];
#ifdef POP_RELAXED
      goto pop_first;
#endif
      b = slot1[index % SLOTS]
    fi;
    goto whole;
pop_first: /* the reader's index reaches memory before its last look at the slot */
    read_index = index + 1;
    b = slot1[index % SLOTS];
    assert(a == expected && b == expected);
    goto popped;
whole:
    assert(a == expected && b == expected);
    read_index = index + 1; /* release: the looks above are over. Its own buffer would only delay it */
popped:
    index++;
    expected++;
    a = 0; b = 0; early0 = 0; early1 = 0
  :: else -> break
  od
}
