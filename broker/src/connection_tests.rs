//! Hostile bytes and silence on one connection; the clock of these tests is set by hand.

use proptest::prelude::*;
use tokio::io::duplex;
use tokio::time::Instant;

use super::*;

fn block_on<T>(future: impl Future<Output = T>) -> T {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build();
    runtime.expect("run-time").block_on(future)
}

/// Reads frames from `bytes`, after which the client closes the connection, or stays silent.
fn frames_of(bytes: &[u8], stays: bool) -> (usize, Result<(), Refusal>) {
    block_on(async {
        let (mut client, mut server) = duplex(1 << 20);
        client.write_all(bytes).await.expect("room");
        let _held = stays.then_some(client);
        let mut buffer = [0; MAX_BYTES + TAG];
        let mut frames = 0;
        loop {
            match read_frame(&mut server, &mut buffer, FRAME_TIME).await {
                Ok(Some(_)) => frames += 1,
                Ok(None) => return (frames, Ok(())),
                Err(refusal) => return (frames, Err(refusal)),
            }
        }
    })
}

fn frame(message: &[u8]) -> Vec<u8> {
    [&(message.len() as u32).to_le_bytes(), message].concat()
}

#[test]
fn every_length_is_taken_or_refused() {
    for length in (0..600).chain([1 << 16, 1 << 31, u32::MAX - 4, u32::MAX]) {
        let mut bytes = length.to_le_bytes().to_vec();
        bytes.resize(4 + (length as usize).min(1000), 7);
        let (frames, end) = frames_of(&bytes, false);
        if (HEAD..=MAX_BYTES + TAG).contains(&(length as usize)) {
            assert_eq!((frames, end), (1, Ok(())), "length {length}");
        } else {
            assert!(matches!(end, Err(Refusal::Malformed(_))), "length {length}: {end:?}");
        }
    }
}

#[test]
fn a_frame_cut_at_any_byte_is_refused() {
    let whole = frame(&service_message(service::SUBSCRIBE, 1, 0, &[2, 0, 0, 0]));
    for n in 1..whole.len() {
        let (frames, end) = frames_of(&whole[..n], false);
        assert!(frames == 0 && matches!(end, Err(Refusal::Malformed(_))), "cut at {n}: {end:?}");
        let (frames, end) = frames_of(&whole[..n], true);
        assert_eq!((frames, end), (0, Err(Refusal::TimedOut("the rest of a frame"))), "silent after {n}");
    }
    assert_eq!(frames_of(&whole, true), (1, Err(Refusal::TimedOut("a frame"))));
}

/// One byte every 100 ms keeps a connection no longer than silence does.
#[test]
fn a_slow_writer_is_cut_off() {
    let taken = block_on(async {
        let (mut client, mut server) = duplex(64);
        let slow = async {
            for byte in frame(&[1; 200]) {
                if client.write_all(&[byte]).await.is_err() {
                    break;
                }
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        };
        let begin = Instant::now();
        let mut buffer = [0; MAX_BYTES + TAG];
        tokio::select! {
            end = read_frame(&mut server, &mut buffer, FRAME_TIME) => {
                assert_eq!(end, Err(Refusal::TimedOut("the rest of a frame")));
            }
            () = slow => panic!("the slow writer was heard to its end"),
        }
        begin.elapsed()
    });
    assert!(taken <= FRAME_TIME + Duration::from_millis(1), "{taken:?}");
}

#[test]
fn a_client_that_does_not_read_loses_its_connection() {
    block_on(async {
        let (_client, server) = duplex(64);
        let (frames, outgoing) = mpsc::channel(WAITING);
        let (_answers, given) = mpsc::unbounded_channel();
        for _ in 0..WAITING {
            frames.try_send(vec![0; 40]).expect("room");
        }
        assert!(frames.try_send(vec![0; 40]).is_err(), "the broker must not wait for it");
        let begin = Instant::now();
        speak(server, given, outgoing, Arc::new(Semaphore::new(0)), Arc::default()).await;
        assert_eq!(begin.elapsed().as_secs(), FRAME_TIME.as_secs());
    });
}

/// Every answer to a frame makes room for another one; news make none.
#[test]
fn answers_give_permits_back() {
    block_on(async {
        let (_client, server) = duplex(1 << 16);
        let (frames, outgoing) = mpsc::channel(WAITING);
        let (answers, given) = mpsc::unbounded_channel();
        let permits = Arc::new(Semaphore::new(0));
        answers.send(service_message(service::ACCEPTED, 7, 0, &[])).expect("open");
        answers.send(Refusal::Busy("x".into()).to_message(8, 0)).expect("open");
        answers.send(service_message(service::LINE, 9, 0, b"x")).expect("open");
        frames.try_send(service_message(service::LEASE, 0, 0, &[0; 12])).expect("room");
        drop((answers, frames));
        speak(server, given, outgoing, permits.clone(), Arc::default()).await;
        assert_eq!(permits.available_permits(), 2);
    });
}

proptest! {
    #[test]
    fn noise_never_panics(noise in prop::collection::vec(any::<u8>(), 0..2000)) {
        let _ = frames_of(&noise, false);
        if let Ok(message) = Message::parse(&noise) {
            let _ = message.command();
        }
    }

    /// Whatever is inside of good frames, the frames are told apart.
    #[test]
    fn frames_are_told_apart(lengths in prop::collection::vec(HEAD..=MAX_BYTES + TAG, 0..20)) {
        let bytes: Vec<u8> = lengths.iter().flat_map(|n| frame(&vec![9; *n])).collect();
        prop_assert_eq!(frames_of(&bytes, false), (lengths.len(), Ok(())));
    }
}
